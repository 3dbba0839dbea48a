# What tests of the strict decoder need beside the libraries; included by the Makefile.
$B/tests/decoder/test_lenient: $(patsubst %,$B/fuzz/%.o,fix_hashes parse places)
$B/tests/decoder/test_canonical $B/tests/decoder/test_hostile: \
    $(patsubst %,$B/fuzz/%.o,fix_hashes parse places)
$B/tests/decoder/test_validate: \
    $(patsubst %,$B/fuzz/%.o,fix_hashes parse places mutate mutate_scene fields)
$B/tests/decoder/test_advise $B/tests/decoder/test_starved: \
    $(patsubst %,$B/fuzz/%.o,fix_hashes parse places)

# Class T (spec E): thresholds by rule, and a judge of records.
CLASS_T_OBJ = $B/conformance/tolerance/class_t.o $(SPEC_EVALS:%=$B/tests/spec/eval_%.o)
$B/conformance/tolerance/class_t.o: $(SPEC_INC)
$B/conformance/tolerance/class_t.o: FPFLAGS = $(STRICT) -I$B/inc
all: $B/ted4tolerance
$B/ted4tolerance: $B/conformance/tolerance/ted4tolerance.o $(CLASS_T_OBJ) \
        $(DEC_TOOL:%.c=$B/%.o) $(DEC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)

# thresholds.csv for vectors of several kinds; takes a minute. tests/tools/test_tolerance.sh says
# whether it is current.
tolerance: $B/ted4tolerance
	sh conformance/tolerance/table.sh $B/ted4tolerance > conformance/tolerance/thresholds.new
	mv conformance/tolerance/thresholds.new conformance/tolerance/thresholds.csv
.PHONY: tolerance
$B/tests/tools/test_tolerance: | $B/ted4tolerance $B/ted4dec

# Counted by the test: hashing, inflating, networks, searches; layers of Tier R.
RESOURCES_COUNTED = XXH3_64bits inflate ted4_prior_hyper_hidden ted4_prior_hyper_some \
        ted4_prior_slice ted4_prior_load ted4_gauss_find ted4_select_strict_dense
$B/tests/decoder/test_resources: $B/tests/decoder/test_resources.o $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $(RESOURCES_COUNTED:%=-Wl,--wrap=%) $^ -o $@ -lcmocka $(LIBS)
