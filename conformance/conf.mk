# The conformance suite; included by the Makefile. CONF_JOBS: processes at a time.
CONF_OBJ   = $(patsubst %.c,$B/%.o,$(wildcard conformance/tool/*.c)) $(DEC_TOOL:%.c=$B/%.o)
CONF_JOBS ?= 2

all: $B/ted4conf
$B/ted4conf: $(CONF_OBJ) $(CLASS_T_OBJ) $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)
# The runner's processes, tried by themselves.
$B/tests/tools/test_process: $(addprefix $B/conformance/tool/,process.o text.o)
$B/tests/tools/test_conformance: | $B/ted4conf $B/ted4dec
$B/tests/tools/test_mutants: | $B/ted4conf
$B/tests/tools/test_suite_schema: | $B/ted4conf $B/ted4dec
$B/tests/tools/test_encoder_program: | $B/ted4conf $B/ted4dec $B/ted4enc $B/ted4scene

# Our library behind the adapter for decoders that are libraries.
$B/adapter: $(addprefix $B/conformance/adapters/,adapter.o ours.o) \
        $(addprefix $B/ref-decoder/tool/,sha256.o tier_hash.o) $B/libted4dec.a
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)
$B/tests/tools/test_adapters: | $B/adapter $B/ted4conf $B/ted4dec

# Our decoder against all vectors, those made on demand too; verdict page in out/.
conformance: $B/ted4conf $B/ted4dec
	@mkdir -p out
	$B/ted4conf run --demand -j $(CONF_JOBS) -t 120 -d $B/ted4dec --second TED4_KERNEL=plain \
	    --json out/conformance.json --junit out/conformance.xml --html out/conformance.html

# All vectors again, from their recipes.
conformance-gen: $B/ted4conf
	$B/ted4conf gen

# What the vectors cover; page in out/.
conformance-cover: $B/ted4conf
	@mkdir -p out
	$B/ted4conf cover --html out/coverage.html --json out/coverage.json

# Branches of norm/ and read/ that they take, in one process, and whether tests take those that only
# a failing allocation, a caller's mistake or a writer can take. Files made on demand come from
# another build: what makes them takes branches too. Of the large ones one: but for its bytes a
# lower level would do.
BRANCH_TEST = build-gcov/tests/decoder/test_starved
conformance-branches: $B/ted4conf
	$(MAKE) B=build-gcov CC=gcc OPT=-O0 CFLAGS=--coverage LDFLAGS=--coverage \
	    build-gcov/ted4conf $(BRANCH_TEST)
	$B/ted4conf gen --demand -o build-gcov/suite/vectors
	$B/ted4conf gen --demand --large --only LVL-2-file-size -o build-gcov/suite/vectors
	find build-gcov -name '*.gcda' -delete
	build-gcov/ted4conf replay --validate --ways --suite build-gcov/suite
	TED4_KERNEL=plain build-gcov/ted4conf replay --suite build-gcov/suite
	sh conformance/branches.sh build-gcov >build-gcov/suite.branches
	find build-gcov -name '*.gcda' -delete
	$(BRANCH_TEST)
	sh conformance/branches.sh build-gcov >build-gcov/tests.branches
	awk -f conformance/branches.awk conformance/branches-excluded.txt \
	    build-gcov/suite.branches build-gcov/tests.branches

# Decoding and queries on several threads under ThreadSanitizer: all vectors, and files of nine
# tiles. Plain kernels too: the sanitizer does not see loads and stores of whole vectors.
conformance-threads: $B/ted4conf
	$(MAKE) B=build-tsan CC='$(CLANG)' OPT=-O1 CFLAGS=-fsanitize=thread \
	    LDFLAGS=-fsanitize=thread build-tsan/ted4conf
	$B/ted4conf gen --demand --only LVL-n_anchors-6 -o build-tsan/nine/vectors
	for suite in conformance build-tsan/nine; do \
	    build-tsan/ted4conf replay --threads 4 --suite $$suite && TED4_KERNEL=plain \
	    build-tsan/ted4conf replay --threads 4 --suite $$suite || exit 1; done

# Seeded faults; what has a result in conformance/mutants.csv that holds is not run again.
conformance-mutants:
	$(MAKE) B=build-mutants OPT=-O1 build-mutants/ted4conf
	build-mutants/ted4conf gen --demand -o build-mutants/suite/vectors
	build-mutants/ted4conf mutants -j $(CONF_JOBS) -b build-mutants \
	    --vectors build-mutants/suite \
	    --compile '$(CC) -std=c11 -D_POSIX_C_SOURCE=200809L -O1 $(STRICT) $(SSE) -fopenmp' \
	    --flags '_avx2.c=-mavx2' --flags '_avx512.c=$(AVX512)' --flags '_vnni.c=$(VNNI)' \
	    --libraries '$(LIBS)'

.PHONY: conformance conformance-gen conformance-cover conformance-branches conformance-threads
.PHONY: conformance-mutants
