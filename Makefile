# TED4: `make deps demo` runs the main job, `make deps test` passes the tests. `make help` lists the rest.
OPT   ?= -O3
ARCH  ?= -march=native
B     ?= build
TED4_DATA ?= ../shared/data

WARN  = -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wmissing-prototypes \
        -Wpointer-arith -Wcast-qual -Wwrite-strings -Wconversion -Wno-sign-conversion -Wundef -Wvla $(WERROR)
# The two FP flags are part of the format (spec 12.2): Tier R is strict binary32.
STRICT = -ffp-contract=off -fno-fast-math
# Informative arithmetic (rendering, training) may contract and use every vector unit of this machine.
FREE   = $(ARCH) -ffp-contract=fast -fno-math-errno -fno-trapping-math
CFLAGS_ALL = -std=c11 -D_POSIX_C_SOURCE=200809L $(OPT) -g $(WARN) -Iref-decoder -Iref-encoder -Itests \
        -fopenmp -MMD -MP $(CFLAGS)
LIBS  = -lpng -ljpeg -ljansson -lxxhash -lz -lm

DEC_SRC  = $(sort $(wildcard $(addprefix ref-decoder/,base/*.c norm/*.c recon/*.c read/*.c render/*.c kernel/*.c)))
ENC_SRC  = $(sort $(wildcard $(addprefix ref-encoder/,write/*.c train/*.c data/*.c eval/*.c kernel/*.c)))
FREE_OBJ = $(patsubst %.c,$B/%.o,$(wildcard ref-decoder/render/*.c ref-encoder/train/*.c ref-encoder/kernel/*.c ref-encoder/eval/*.c))
DEC_TOOL = $(filter-out ref-decoder/tool/ted4%.c,$(wildcard ref-decoder/tool/*.c))
ENC_TOOL = $(filter-out ref-encoder/tool/ted4%.c,$(wildcard ref-encoder/tool/*.c))
DEC_PROG = $(patsubst ref-decoder/tool/%.c,%,$(wildcard ref-decoder/tool/ted4*.c))
ENC_PROG = $(patsubst ref-encoder/tool/%.c,%,$(wildcard ref-encoder/tool/ted4*.c))
PROGS    = $(addprefix $B/,$(DEC_PROG) $(ENC_PROG) ted4scene)
TESTS    = $(patsubst tests/%.c,$B/tests/%,$(sort $(wildcard tests/test_*.c)))

all: $(PROGS)

$B/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) $(FPFLAGS) -c $< -o $@
$B/%.o: FPFLAGS = $(STRICT)
$(FREE_OBJ): FPFLAGS = $(FREE)
# Only files named for an instruction set may use it; the compiler enforces it.
$B/ref-decoder/kernel/%_avx2.o: FPFLAGS = $(STRICT) -mavx2
$B/ref-decoder/kernel/%_avx512.o: FPFLAGS = $(STRICT) -mavx512f -mavx512bw -mavx512vl -mprefer-vector-width=512

$B/libted4dec.a: $(DEC_SRC:%.c=$B/%.o)
$B/libted4enc.a: $(ENC_SRC:%.c=$B/%.o)
$B/lib%.a:
	@rm -f $@
	$(AR) rcsD $@ $^

# Link order says the architecture: a decoder tool sees the decoder library only.
$(addprefix $B/,$(DEC_PROG)): $B/%: $B/ref-decoder/tool/%.o $(DEC_TOOL:%.c=$B/%.o) $B/libted4dec.a
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)
$(addprefix $B/,$(ENC_PROG)): $B/%: $B/ref-encoder/tool/%.o $(ENC_TOOL:%.c=$B/%.o) $B/libted4enc.a $B/libted4dec.a
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)
$B/ted4scene: $(patsubst %.c,$B/%.o,$(wildcard tests/scenes/*.c)) $B/libted4enc.a $B/libted4dec.a
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)
$B/tests/%: $B/tests/%.o $B/libted4enc.a $B/libted4dec.a
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ -lcmocka $(LIBS)

test: $(TESTS) $(PROGS)
	@B=$B TED4_DATA=$(TED4_DATA) tests/run.sh $(TESTS)

clean:
	rm -rf build build-*

.PHONY: all test clean
.SECONDARY:
-include $(shell find $B -name '*.d' 2>/dev/null)
