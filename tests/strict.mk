# What tests of the strict decoder need beside the libraries; included by the Makefile.
$B/tests/test_lenient: $(patsubst %,$B/fuzz/%.o,mend parse)
$B/tests/test_validate: $(patsubst %,$B/fuzz/%.o,mend parse mutate fields)

# Class T (spec E): thresholds by rule, and a judge of records.
TOLERANCE_OBJ = $B/conformance/tolerance/ted4tolerance.o
$(TOLERANCE_OBJ): $(SPEC_INC)
$(TOLERANCE_OBJ): FPFLAGS = $(STRICT) -I$B/inc
all: $B/ted4tolerance
$B/ted4tolerance: $(TOLERANCE_OBJ) $(SPEC_EVALS:%=$B/tests/spec/eval_%.o) $(DEC_TOOL:%.c=$B/%.o) $B/libted4dec.a
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)

# thresholds.csv for all valid vectors that have queries; tests/test_tolerance.sh says whether it is current.
tolerance: $B/ted4tolerance
	sh conformance/tolerance/table.sh $B/ted4tolerance > conformance/tolerance/thresholds.new
	mv conformance/tolerance/thresholds.new conformance/tolerance/thresholds.csv
.PHONY: tolerance
