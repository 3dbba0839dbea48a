# Fuzzing; included by the Makefile. fuzz/README.md says what the targets are for.
#   make fuzz-build [FUZZ_KIND=asan|msan|afl]   every harness as a program in build-fuzz-KIND/fuzz/
#   make fuzz [FUZZ_SECONDS=60] [FUZZ_JOBS=1]   each harness for so long, added to fuzz/runs.csv
#                                               (fuzz/run.sh)
#   make fuzz-replay                            all seeds and regressions under ASan and UBSan,
#                                               without libFuzzer
#   make fuzz-coverage                          what the seeds cover, into fuzz/README.md
#   make fuzz-corpus                            writes the seeds again
FUZZERS       = $(shell grep -o '^FUZZ.[a-z_0-9]*' fuzz/list.def | cut -c6-)
FUZZ_KIND    ?= asan
FUZZ_SECONDS ?= 60
FUZZ_JOBS    ?= 1
FUZZ_SAN      = -fsanitize=address,undefined -fno-sanitize-recover=all

# Wrapped by the linker: what alloc_fail lets fail; a program that scenes with clips would start;
# what MSan cannot see zlib write.
FUZZ_ALLOC    = -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=free
FUZZ_NO_VIDEO = -Wl,--wrap=ted4_video_unpack
FUZZ_SEEN     = -Wl,--wrap=inflate,--wrap=compress2,--wrap=uncompress2

FUZZ_OBJ      = $(patsubst %.c,$B/%.o,fuzz/fix_hashes.c fuzz/parse.c fuzz/places.c)
# A harness links what it looks at, so that a build for one kind of instrumentation stays small:
# decoder and writer; readers of scenes too; or all.
FUZZ_CODEC    = $(patsubst %.c,$B/%.o,$(DEC_SRC) \
                $(wildcard ref-encoder/math/*.c ref-encoder/write/*.c)) $(FUZZ_OBJ)
FUZZ_SCENE    = $(patsubst %.c,$B/%.o,$(wildcard ref-encoder/data/*.c) \
                $(addprefix ref-decoder/tool/,camera_lens.c camera_list.c camera_transforms.c \
                json_file.c read_file.c times.c) fuzz/scene_folder.c)
FUZZ_MUTATE   = $(patsubst %,$B/fuzz/%.o,mutate mutate_scene fields)
# Inputs that are .ted4 files have a mutator that knows them.
FUZZ_FILES    = decode decode_chunked editor roundtrip recon alloc_fail dump validate lenient \
                two_decoders
FUZZ_SCENES   = colmap transforms calibration hypernerf npy ply image camera_list

# What the specification prints, extracted (tests/spec/spec.mk).
$B/fuzz/fz_two_decoders.o $B/fuzz/all/fz_two_decoders.o: $(SPEC_INC)
$B/fuzz/fz_two_decoders.o $B/fuzz/all/fz_two_decoders.o: STRICT += -I$B/inc

# One program for all, each entry under the harness's name.
FUZZ_ALL      = $(FUZZERS:%=$B/fuzz/all/fz_%.o) $(patsubst %,$B/fuzz/%.o,inputs scene_folder) \
                $(FUZZ_OBJ) $(DEC_TOOL:%.c=$B/%.o) $(ENC_LIB)
$B/fuzz/all/fz_%.o: fuzz/fz_%.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) $(STRICT) -DLLVMFuzzerTestOneInput=fuzz_$* -c $< -o $@
$B/fuzz/replay: $B/fuzz/main.o $(FUZZ_ALL)
	$(CC) -fopenmp $(LDFLAGS) $(FUZZ_ALLOC) $(FUZZ_NO_VIDEO) $^ -o $@ $(LIBS)
$B/tests/tools/test_fuzz: $B/tests/tools/test_fuzz.o $(FUZZ_MUTATE) $(FUZZ_ALL)
	$(CC) -fopenmp $(LDFLAGS) $(FUZZ_ALLOC) $(FUZZ_NO_VIDEO) $^ -o $@ -lcmocka $(LIBS)

# One program a harness, with libFuzzer's main or AFL++'s.
ifneq ($(FUZZ_KIND),afl)
$(FUZZ_FILES:%=$B/fuzz/fuzz_%): $B/fuzz/mutator.o $(FUZZ_MUTATE)
$B/fuzz/fuzz_container: $B/fuzz/mutator_frames.o $(FUZZ_MUTATE)
endif
$(FUZZ_SCENES:%=$B/fuzz/fuzz_%): $(FUZZ_SCENE)
$B/fuzz/fuzz_decode_chunked: $B/ref-decoder/tool/read_file.o
$B/fuzz/fuzz_cams: $B/ref-decoder/tool/cams.o $B/ref-decoder/tool/chunks.o
$B/fuzz/fuzz_checkpoint: $B/fuzz/scene_folder.o $(ENC_LIB)
$B/fuzz/fuzz_alloc_fail: FUZZ_LINK = $(FUZZ_ALLOC)
$(patsubst %,$B/fuzz/fuzz_%,$(FUZZ_SCENES) checkpoint): FUZZ_LINK = $(FUZZ_NO_VIDEO)
# FUZZ_ENGINE: what brings main; LD_FUZZ: what links it, as an engine may be C++.
FUZZ_ENGINE  ?= -fopenmp -fsanitize=fuzzer
LD_FUZZ      ?= $(CC)
$B/fuzz/fuzz_%: $B/fuzz/fz_%.o $(FUZZ_CODEC)
	$(LD_FUZZ) $(CFLAGS) $(LDFLAGS) $(FUZZ_LINK) $^ $(FUZZ_ENGINE) -o $@ $(LIBS)

# Other programs of this folder.
$B/fuzz/mutate: $B/fuzz/mutate_tool.o $(FUZZ_MUTATE) $(FUZZ_CODEC)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)
$B/fuzz/afl_mutator.so: $B/fuzz/afl_mutator.o $(FUZZ_MUTATE) $(FUZZ_CODEC)
	$(CC) -shared $(LDFLAGS) $^ -o $@ $(LIBS)
$B/fuzz/make_corpus: $(patsubst %,$B/fuzz/%.o,make_corpus corpus_units corpus_scenes \
        corpus_write) $B/ref-decoder/tool/cams.o $(FUZZ_MUTATE) $(FUZZ_CODEC)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)
$B/bench/robust: $B/bench/robust.o $(FUZZ_CODEC)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)

# MSan knows only what it has compiled, so xxHash is compiled in, zlib's output is declared written
# (msan_zlib.c), and harnesses that go through libpng, libjpeg or jansson, or train, are left out.
FUZZ_MSAN     = $(filter-out colmap transforms calibration hypernerf npy image camera_list \
                checkpoint,$(FUZZERS))
FUZZ_NO_LINK  = -fsanitize=fuzzer-no-link
fuzz-build: fuzz-build-$(FUZZ_KIND)
fuzz-build-asan:
	$(MAKE) B=build-fuzz-asan CC='$(CLANG)' OPT=-O1 CFLAGS='$(FUZZ_NO_LINK) $(FUZZ_SAN)' \
	    LDFLAGS='-fsanitize=address,undefined' $(FUZZERS:%=build-fuzz-asan/fuzz/fuzz_%)
fuzz-build-msan:
	$(MAKE) B=build-fuzz-msan CC='$(CLANG)' OPT=-O1 \
	    CFLAGS='$(FUZZ_NO_LINK) -fsanitize=memory -DXXH_INLINE_ALL' \
	    build-fuzz-msan/fuzz/msan_zlib.o
	$(MAKE) B=build-fuzz-msan CC='$(CLANG)' OPT=-O1 \
	    CFLAGS='$(FUZZ_NO_LINK) -fsanitize=memory -DXXH_INLINE_ALL' \
	    LDFLAGS='-fsanitize=memory $(FUZZ_SEEN) build-fuzz-msan/fuzz/msan_zlib.o' \
	    $(FUZZ_MSAN:%=build-fuzz-msan/fuzz/fuzz_%)
fuzz-build-afl:
	$(MAKE) B=build-fuzz-afl FUZZ_KIND=afl CC=afl-clang-fast OPT=-O2 \
	    $(FUZZERS:%=build-fuzz-afl/fuzz/fuzz_%)
	$(MAKE) B=build-fuzz-pic CFLAGS=-fPIC build-fuzz-pic/fuzz/afl_mutator.so

fuzz-scenes:
	@echo $(FUZZ_SCENES)

fuzz:
	fuzz/run.sh -t $(FUZZ_SECONDS) -s $(FUZZ_SECONDS) -j $(FUZZ_JOBS) -k $(FUZZ_KIND)

# The objects of `make asan`.
fuzz-replay:
	$(MAKE) B=build-asan OPT=-O1 CFLAGS='$(FUZZ_SAN)' \
	    LDFLAGS='-fsanitize=address,undefined' build-asan/fuzz/replay
	@fuzz/replay.sh build-asan/fuzz/replay

fuzz-coverage:
	$(MAKE) B=build-fuzz-cov CC='$(CLANG)' OPT=-O1 \
	    CFLAGS='-fprofile-instr-generate -fcoverage-mapping' \
	    LDFLAGS=-fprofile-instr-generate build-fuzz-cov/fuzz/replay
	LLVM_VERSION=$(CLANG_VERSION) fuzz/coverage.sh build-fuzz-cov/fuzz/replay

fuzz-corpus: $B/fuzz/make_corpus
	$B/fuzz/make_corpus fuzz/corpus

.PHONY: fuzz fuzz-scenes fuzz-build fuzz-build-asan fuzz-build-msan fuzz-build-afl fuzz-corpus
.PHONY: fuzz-replay fuzz-coverage
