# TED4: `make deps demo` runs the main job, `make deps test` passes the tests. `make help` lists the
# rest.
all:

# The command line sets these. What the environment calls so is somebody else's: build systems set
# ARCH=x86_64.
$(foreach v,OPT B ARCH,$(if $(filter environment,$(origin $v)),$(eval undefine $v)))
OPT   ?= -O3
B     ?= build
TED4_DATA ?= ../shared/data

WARN  = -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wmissing-prototypes \
        -Wpointer-arith -Wcast-qual -Wwrite-strings -Wconversion -Wno-sign-conversion \
        -Wundef -Wvla $(CALM) $(WERROR)
# clang 19 counts enumerations that become floats among the mistakes of -Wconversion; gcc has no
# such warning.
CALM := $(shell $(CC) -Werror -Wenum-float-conversion -x c -fsyntax-only /dev/null 2>/dev/null && \
        echo -Wno-enum-float-conversion)
# The two FP flags are part of the format (spec 12.2): Tier R is strict binary32.
STRICT = -ffp-contract=off -fno-fast-math
# Rendering and training: every operation is rounded as it is written, so that all machines and
# compilers give the same bits; fused operations are explicit (render/leveled.h). ARCH=-march=native
# lets the compiler use this machine's instructions everywhere.
FREE   = $(ARCH) -Wno-psabi -ffp-contract=off -fno-math-errno -fno-trapping-math
# Files compiled once a level of instruction sets, of which base/level.c chooses one when a program
# runs.
MACHINE := $(firstword $(subst -, ,$(shell $(CC) $(CFLAGS) -dumpmachine)))
# gcc -m32 still says x86_64.
ifneq ($(findstring __i386__,$(shell $(CC) $(CFLAGS) -dM -E -x c /dev/null)),)
MACHINE := i686
endif
LEVELS  = $(if $(filter x86_64,$(MACHINE)),base v3 v4,base)
LEVELED = $(addprefix ref-decoder/render/,project.c blend.c) \
          $(addprefix ref-encoder/kernel/,dense_product.c dense_weights.c) \
          $(addprefix ref-encoder/train/,raster/blend_bwd.c raster/project_bwd.c \
          splat/decode_fwd.c splat/decode_bwd.c splat/view_colours.c splat/chain.c \
          splat/effective_layer.c \
          rate/rate_fwd.c rate/rate_bwd.c rate/rate_row.c rate/rate_decoded.c \
          model/quantise_block.c math/adam_step.c densify/sweep_depths.c loss/loss_passes.c \
          loss/camera_colour_bands.c)
# Rows are short and may lie anywhere: gcc would take one lane at a time until a store is aligned,
# and clang has no such option.
NO_PEELING = --param=vect-max-peeling-for-alignment=0
LANES := $(shell $(CC) -Werror $(NO_PEELING) -x c -fsyntax-only /dev/null 2>/dev/null && \
        echo $(NO_PEELING))
FLAGS_v3 = -mavx2 -mfma -mbmi -mbmi2
FLAGS_v4 = $(FLAGS_v3) -mavx512f -mavx512bw -mavx512dq -mavx512vl -mprefer-vector-width=512
# Objects of the sources $(1), with all copies of leveled ones.
OBJECTS = $(patsubst %.c,$B/%.o,$(filter-out $(LEVELED),$(1))) \
          $(foreach l,$(LEVELS),$(patsubst %.c,$B/%.$l.o,$(filter $(LEVELED),$(1))))
CFLAGS_ALL = -std=c11 -D_POSIX_C_SOURCE=200809L $(OPT) -g $(WARN) \
        -Iref-decoder -Iref-encoder -Itests/support -I. -fopenmp -MMD -MP $(FILES64) $(SSE) \
        $(CPPFLAGS) $(CFLAGS)
# Files of more than 2 GiB where a long has 32 bits.
FILES64 = -D_FILE_OFFSET_BITS=64
# The x87 of older processors keeps more bits than binary32 has, so nothing would be rounded as it
# is written.
SSE = $(if $(filter i386 i486 i586 i686,$(MACHINE)),-msse2 -mfpmath=sse)
LIBS  = -lpng -ljpeg -ljansson -lxxhash -lz -lm

DEC_SRC  = $(sort $(wildcard \
           $(addprefix ref-decoder/,base/*.c norm/*.c recon/*.c read/*.c kernel/*.c)))
DRAW_SRC = $(sort $(wildcard ref-decoder/render/*.c))
# Whatever lies below train/ is free, however deep.
TRAIN_SRC = $(sort $(shell find ref-encoder/train -name '*.c'))
ENC_SRC  = $(sort $(wildcard $(addprefix ref-encoder/,math/*.c write/*.c data/*.c eval/*.c \
           kernel/*.c)) $(TRAIN_SRC))
FREE_OBJ = $(patsubst %.c,$B/%.o,$(DRAW_SRC) $(TRAIN_SRC) $(wildcard ref-encoder/kernel/*.c \
           ref-encoder/eval/*.c))
DEC_TOOL = $(filter-out ref-decoder/tool/ted4%.c,$(wildcard ref-decoder/tool/*.c))
ENC_TOOL = $(filter-out ref-encoder/tool/ted4%.c,$(wildcard ref-encoder/tool/*.c))
DEC_PROG = $(patsubst ref-decoder/tool/%.c,%,$(wildcard ref-decoder/tool/ted4*.c))
ENC_PROG = $(patsubst ref-encoder/tool/%.c,%,$(wildcard ref-encoder/tool/ted4*.c))
PROGS    = $(addprefix $B/,$(DEC_PROG) $(ENC_PROG) ted4scene)
SCENE_SRC = $(filter-out %/ted4scene.c,$(wildcard tools/scene/*.c))
TESTS    = $(patsubst %.c,$B/%,$(sort $(wildcard tests/*/test_*.c))) \
           $(patsubst %.sh,$B/%,$(sort $(wildcard tests/*/test_*.sh)))

all: $(PROGS)

# Changes when compiler or flags do; then everything is compiled anew.
HOW = $(CC) $(CFLAGS_ALL) $(LIBRARY_FLAGS) $(STRICT) $(FREE) $(LANES) $(FLAGS_v3) $(FLAGS_v4)
$B/how: always
	@mkdir -p $(@D)
	@echo '$(HOW)' | cmp -s - $@ || echo '$(HOW)' >$@

$B/%.o: %.c $B/how
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) $(FPFLAGS) $(LIBRARY) -c $< -o $@
$B/%.o: FPFLAGS = $(STRICT)
$(FREE_OBJ): FPFLAGS = $(FREE)
# Only files named for an instruction set may use it; the compiler enforces it.
AVX512 = -mavx512f -mavx512bw -mavx512vl -mprefer-vector-width=512
VNNI   = -mavx512f -mavx512bw -mavx512vl -mavx512vnni -mprefer-vector-width=512
ifeq ($(MACHINE),x86_64)
$B/ref-decoder/kernel/%_avx2.o: FPFLAGS = $(STRICT) -mavx2
$B/ref-decoder/kernel/%_avx512.o: FPFLAGS = $(STRICT) $(AVX512)
$B/ref-decoder/kernel/%_vnni.o: FPFLAGS = $(STRICT) $(VNNI)
endif

# $(1): level
define COMPILE_LEVEL
$B/%.$(1).o: %.c $B/how
	@mkdir -p $$(@D)
	$$(CC) $$(CFLAGS_ALL) $$(FREE) $$(LANES) $$(FLAGS_$(1)) -DTED4_LEVEL=$(1) -c $$< -o $$@
endef
$(foreach l,$(LEVELS),$(eval $(call COMPILE_LEVEL,$l)))

$B/libted4dec.a: $(call OBJECTS,$(DEC_SRC))
$B/libted4render.a: $(call OBJECTS,$(DRAW_SRC))
# Loading a scene unpacks videos, whose frames a signal removes.
$B/libted4enc.a: $(call OBJECTS,$(ENC_SRC)) $B/ref-decoder/tool/leftovers.o
$B/lib%.a:
	@rm -f $@
	$(AR) rcsD $@ $^

# Link order says the architecture: a decoder tool sees the decoder library, and the informative one
# that draws what it gives; only this one may use libpng and malloc. The encoder stands on both.
DEC_LIB  = $B/libted4render.a $B/libted4dec.a
ENC_LIB  = $B/libted4enc.a $(DEC_LIB)
$(addprefix $B/,$(DEC_PROG)): $B/%: $B/ref-decoder/tool/%.o $(DEC_TOOL:%.c=$B/%.o) $(DEC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)
$(addprefix $B/,$(ENC_PROG)): $B/%: $B/ref-encoder/tool/%.o $(ENC_TOOL:%.c=$B/%.o) \
        $(DEC_TOOL:%.c=$B/%.o) $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)
$B/ted4scene: $B/tools/scene/ted4scene.o $(SCENE_SRC:%.c=$B/%.o) $(DEC_TOOL:%.c=$B/%.o) \
        $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)
$B/tests/%: $B/tests/%.o $(DEC_TOOL:%.c=$B/%.o) $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $(filter %.o,$^) $(filter %.a,$^) -o $@ -lcmocka $(LIBS)
$B/tests/%: tests/%.sh
	@mkdir -p $(@D)
	install -m 755 $< $@

# Tests of the scene maker, or with its scenes.
SCENE_TESTS = tools/test_scene tools/test_scene_shapes tools/test_scene_sets \
        tools/test_failure_scenes tools/test_scene_colours tools/test_relay \
        tools/test_motion_points tools/test_ways encoder/test_layouts encoder/test_hold_out \
        encoder/test_exposure
$(SCENE_TESTS:%=$B/tests/%): $(SCENE_SRC:%.c=$B/%.o)
$B/tests/tools/test_run_log: $(addprefix $B/ref-encoder/tool/,run_log.o json_line.o teller.o)
$B/tests/tools/test_teller: $B/ref-encoder/tool/teller.o
$B/tests/tools/test_align: $B/ref-encoder/tool/align.o
$B/tests/tools/test_belongs: $(addprefix $B/ref-encoder/tool/,belongs.o sheet.o)
$B/tests/tools/test_edit: $B/ref-encoder/tool/edit.o
$B/tests/tools/test_fit_colours: $B/ref-encoder/tool/fit_colours.o
$B/tests/tools/test_moving_pixels: $B/ref-encoder/tool/moving_pixels.o
$B/tests/encoder/test_checkpoint_fields: $B/ref-encoder/tool/search_report.o
$B/tests/tools/test_estimate: $B/ref-encoder/tool/estimate.o
$B/tests/tools/test_install $B/tests/tools/test_library: | $(PROGS) $(SHARED) $B/ted4conf \
        $B/ted4tolerance man
$B/tests/tools/test_look: $(ENC_TOOL:%.c=$B/%.o)
$B/tests/tools/test_output: $B/ref-encoder/tool/file_out.o
$B/tests/tools/test_output: override LDFLAGS += -Wl,--wrap=fsync,--wrap=link
$B/tests/tools/test_conf_folder: | $B/ted4conf
$B/tests/tools/test_kernels $B/tests/tools/test_outputs: | $B/ted4conf $B/ted4tolerance
$B/tests/tools/test_stop: $B/ref-encoder/tool/stop.o
$B/tests/tools/test_thumbnail: $B/ref-encoder/tool/describe.o
$B/tests/tools/test_verify: $B/ref-encoder/tool/verify.o
$(addprefix $B/tests/encoder/test_starved_,trainer writer): override LDFLAGS += \
        -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=aligned_alloc

test-programs: all $(TESTS)

# What a user builds in order to see something is built on all cores, unless -j says on how many.
# nproc would obey OpenMP's variables, and not every system has it.
CORES = $(shell env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc 2>/dev/null || \
        getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)
JOBS = $(if $(findstring -j,$(MAKEFLAGS)),,-j$(CORES))

# Lints take seconds. Prints each test program it runs and a closing line of totals.
test: lint
	@$(MAKE) --no-print-directory $(JOBS) test-programs
	@TED4_BUILD="$(abspath $B)" TED4_DATA="$(abspath $(TED4_DATA))" sh tests/run.sh $(TESTS)

# Scene, training, file, decoder in a fresh process, held-out views, picture sheet: in out/demo.
demo:
	@$(MAKE) --no-print-directory $(JOBS) $(PROGS)
	@TED4_BUILD="$(abspath $B)" sh tools/demo.sh out/demo

lint:
	@unset POSIXLY_CORRECT; for l in tests/lint/*.sh; do LC_ALL=C sh $$l || exit 1; done

# Both compilers, warnings as errors.
CLANG_VERSION ?= 14
CLANG ?= clang-$(CLANG_VERSION)
BOTH = build-gcc build-clang
COMPILER_build-gcc   = gcc
COMPILER_build-clang = $(CLANG)
BUILD_OF = B=$(1) CC='$(COMPILER_$(1))' WERROR=-Werror
$(BOTH): always
	$(MAKE) $(call BUILD_OF,$@) test-programs

# Lints, both compilers, tests with one. All levels that the machine has, with both: test-machines;
# TEST_LEVELS="v1 v3" names some.
check: lint $(BOTH)
	$(MAKE) $(call BUILD_OF,build-gcc) test
test-machines: export TEST_LEVELS := $(TEST_LEVELS)
test-machines: export TED4_DATA := $(abspath $(TED4_DATA))
test-machines: lint
	@$(MAKE) --no-print-directory -k $(BOTH:%=%-levels)
$(BOTH:%=%-levels): %-levels: %
	@$(MAKE) --no-print-directory $(call BUILD_OF,$*) test-levels
test-levels:
	@sh tests/machines.sh $B

asan:
	$(MAKE) test B=build-asan OPT='-O1' \
	    CFLAGS='-fsanitize=address,undefined -fno-sanitize-recover=all -Wno-pass-failed' \
	    LDFLAGS='-fsanitize=address,undefined'

include ref-decoder/library.mk tests/spec/spec.mk tests/strict.mk bench/bench.mk fuzz/fuzz.mk
include conformance/conf.mk conformance/reader/reader.mk conformance/cross/cross.mk
include ref-encoder/mpi/mpi.mk
include player/player.mk tools/pages/pages.mk tools/packages.mk tests/mutants/mutants.mk

DEPS     = gcc libc6-dev libcmocka-dev libjansson-dev libjpeg-dev libpng-dev libxxhash-dev \
           python3 zlib1g-dev
DEPS_DEV = clang-$(CLANG_VERSION) clang-format-14 llvm-$(CLANG_VERSION) \
           libclang-rt-$(CLANG_VERSION)-dev libomp-$(CLANG_VERSION)-dev afl++ ffmpeg pandoc \
           lcov valgrind cmake g++ pkg-config python3-numpy abigail-tools
SUDO     = $(shell [ "$$(id -u)" = 0 ] || echo sudo)
INSTALL_DEBIAN = missing=$$(for p in $(1); do \
	dpkg-query -W -f='$${Status}' $$p 2>/dev/null | grep -q 'ok installed' || echo $$p; done); \
	if [ -n "$$missing" ]; then $(SUDO) apt-get update -q && \
	$(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends \
	    $$missing; fi
deps:
	@$(call INSTALL_DEBIAN,$(DEPS))
deps-dev: deps
	@$(call INSTALL_DEBIAN,$(DEPS_DEV))

# The other libraries have no public header.
PREFIX  ?= /usr/local
install: install-programs install-library install-pages
# By itself where the programs are for another machine: pages are written by running them.
install-programs: all
	install -d "$(DESTDIR)$(PREFIX)/bin"
	install $(PROGS) $B/ted4conf $B/ted4tolerance "$(DESTDIR)$(PREFIX)/bin"

# What install has written, by name: nothing is built for it. Of folders, only TED4's own go, and
# only when nothing else lies in them. The other rules are beside those of install.
# $(1): files, or folders, in $(2)
REMOVE = for f in $(1); do rm -f "$(2)/$$f" || exit; done
REMOVE_FOLDERS = for f in $(1); do rmdir "$(2)/$$f" 2>/dev/null || :; done
uninstall::
	$(call REMOVE,$(notdir $(PROGS)) ted4conf ted4tolerance,$(DESTDIR)$(PREFIX)/bin)

# All targets, of the included files too; tests/lint/help.sh sees that none is missing.
help:
	@cat tools/make-help.txt

clean:
	rm -rf build build-* out

.PHONY: all always test-programs test test-machines test-levels $(BOTH) $(BOTH:%=%-levels)
.PHONY: demo lint check asan deps deps-dev install install-programs uninstall help clean
.SECONDARY:
-include $(shell find $B -name '*.d' 2>/dev/null)
