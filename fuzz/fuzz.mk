# Fuzzing; included by the Makefile. FUZZ_SECONDS: for each harness. What is found lies in build-fuzz/found.
FUZZERS       = fz_decode fz_container fz_roundtrip
FUZZ_SECONDS ?= 60
FUZZ_OBJ      = $(patsubst %.c,$B/%.o,$(filter-out ref-decoder/render/%,$(DEC_SRC)) $(wildcard ref-encoder/write/*.c) fuzz/mend.c)
FUZZ_SAN      = -fsanitize=address,undefined -fno-sanitize-recover=all
FUZZ_LIBS     = -lxxhash -lz -lm

$B/fuzz/fuzz_%: $B/fuzz/fz_%.o $B/fuzz/mutator.o $(FUZZ_OBJ)
	$(CC) -fsanitize=fuzzer,address,undefined $^ -o $@ $(FUZZ_LIBS)
$B/fuzz/replay_%: $B/fuzz/fz_%.o $B/fuzz/main.o $(FUZZ_OBJ)
	$(CC) $(LDFLAGS) $^ -o $@ $(FUZZ_LIBS)
$B/fuzz/make_corpus: $B/fuzz/make_corpus.o $(FUZZ_OBJ)
	$(CC) $(LDFLAGS) $^ -o $@ $(FUZZ_LIBS)
$B/bench/robust: $B/bench/robust.o $(FUZZ_OBJ)
	$(CC) $(LDFLAGS) $^ -o $@ $(FUZZ_LIBS)
$B/tests/test_fuzz: $B/fuzz/mend.o

fuzz-corpus: $B/fuzz/make_corpus
	$B/fuzz/make_corpus fuzz/corpus

fuzz:
	$(MAKE) B=build-fuzz CC=clang-14 OPT=-O1 CFLAGS='-fsanitize=fuzzer-no-link $(FUZZ_SAN)' $(FUZZERS:fz_%=build-fuzz/fuzz/fuzz_%)
	@for h in $(FUZZERS:fz_%=%); do \
	    mkdir -p build-fuzz/corpus/$$h build-fuzz/found; echo "== $$h"; \
	    build-fuzz/fuzz/fuzz_$$h -max_total_time=$(FUZZ_SECONDS) -max_len=4096 -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 \
	        -verbosity=0 -artifact_prefix=build-fuzz/found/$$h- build-fuzz/corpus/$$h fuzz/corpus || exit 1; \
	done

# The objects of `make asan`.
fuzz-replay:
	$(MAKE) B=build-asan OPT=-O1 CFLAGS='$(FUZZ_SAN)' LDFLAGS='-fsanitize=address,undefined' \
	    $(FUZZERS:fz_%=build-asan/fuzz/replay_%)
	@for h in $(FUZZERS:fz_%=%); do build-asan/fuzz/replay_$$h fuzz/corpus/* || exit 1; done

.PHONY: fuzz fuzz-corpus fuzz-replay
