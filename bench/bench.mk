# Benchmarks; included by the Makefile. The plain build answers what vectors bring: the same sources for any x86-64, with the
# compiler's vectoriser off (vector types become SSE2 operations).
RASTER_BENCH = ref-decoder/render/raster.c ref-decoder/render/project.c ref-decoder/render/bin.c ref-decoder/render/blend.c \
        ref-encoder/train/raster_bwd.c ref-encoder/train/blend_bwd.c ref-encoder/train/project_bwd.c \
        ref-decoder/tool/threads.c bench/bench_raster.c

$B/bench/bench_raster.o: FPFLAGS = $(FREE)
$B/bench/bench_raster: $(RASTER_BENCH:%.c=$B/%.o)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ -lm

$B/plain/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) $(FREE) -O2 -fno-tree-vectorize -march=x86-64 -mtune=generic -Wno-psabi -c $< -o $@
$B/plain/bench_raster: $(RASTER_BENCH:%.c=$B/plain/%.o)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ -lm

bench-raster: $B/bench/bench_raster $B/plain/bench_raster
	$B/bench/bench_raster $B/plain/bench_raster

.PHONY: bench-raster

# What the integer entropy model and the range coder cost: make rate-check FILE=x.ted4
$B/bench/rate_check: $B/bench/rate_check.o $B/libted4enc.a $B/libted4dec.a
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)

rate-check: $B/bench/rate_check
	$B/bench/rate_check $(FILE)

.PHONY: rate-check

# Evidence on real scenes; resumable, about an hour on two cores.
real: all
	TED4_BUILD=$B TED4_DATA=$(TED4_DATA) bench/real.sh

.PHONY: real
