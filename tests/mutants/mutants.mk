# Mutants of the encoder; included by the Makefile.
MUTANTS_OBJ = $(patsubst %.c,$B/%.o,$(filter-out %/ted4conf.c,$(wildcard conformance/tool/*.c))) \
        $(DEC_TOOL:%.c=$B/%.o)

$B/encoder_mutants: $B/tests/mutants/encoder_mutants.o $(MUTANTS_OBJ) $(CLASS_T_OBJ) $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)
$B/tests/tools/test_encoder_mutants: | $B/encoder_mutants

# Seeded faults; what has a result in tests/mutants/mutants.csv that holds is not run again.
# MUTANTS="--only adam" runs some.
encoder-mutants: export TED4_DATA := $(abspath $(TED4_DATA))
encoder-mutants:
	$(MAKE) B=build-mutants OPT=-O1 build-mutants/encoder_mutants build-mutants/libted4enc.a
	build-mutants/encoder_mutants -b build-mutants --make '$(MAKE) B=build-mutants OPT=-O1' \
	    $(MUTANTS)

.PHONY: encoder-mutants
