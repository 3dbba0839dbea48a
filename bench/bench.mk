# Benchmarks; included by the Makefile.
BENCH_FREE = $(FREE) -DTED4_LEVEL=base

$B/bench/bench_raster.o: FPFLAGS = $(BENCH_FREE)
$B/bench/bench_raster: $B/bench/bench_raster.o $B/ref-decoder/tool/threads.o $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)

$B/bench/bench_seeding.o: FPFLAGS = $(BENCH_FREE)
$B/bench/bench_seeding: $B/bench/bench_seeding.o $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)

KEEP = MAKE_TARGET=$@ CC='$(CC)' sh bench/keep.sh

# These four print their tables and keep them in bench/raster.md, bench/seeding.md, bench/render.md
# and bench/train.md.
bench-raster: $B/bench/bench_raster
	$(KEEP) bench/raster.md $B/bench/bench_raster

bench-seeding: $B/bench/bench_seeding
	$(KEEP) bench/seeding.md $B/bench/bench_seeding

$B/bench/bench_render.o: FPFLAGS = $(BENCH_FREE)
$B/bench/bench_render: $B/bench/bench_render.o $B/ref-decoder/tool/threads.o $(DEC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)

bench-render: $B/bench/bench_render
	$(KEEP) bench/render.md $B/bench/bench_render

# Parts of a step are told apart by functions that train_parts.c puts in between.
LEVELED_PARTS = ted4_raster_project ted4_raster_blend ted4_raster_blend_bwd ted4_raster_project_bwd
TRAIN_PARTS = ted4_dataset_pixels ted4_trainer_check ted4_schedule_event ted4_visible_blocks_of \
        ted4_visible_blocks_wake \
        ted4_generator_pack ted4_generate \
        ted4_raster_bin ted4_loss $(foreach l,base v3 v4,$(LEVELED_PARTS:%=%_$l)) \
        ted4_generate_backward ted4_update_volume ted4_update_bank ted4_densify_gather \
        ted4_update_rate ted4_update_parameters
BETWEEN = $(TRAIN_PARTS:%=-Wl,--wrap=%)

TRAIN_RECORD = $B/bench/train_parts.o $B/bench/train_record.o
$(TRAIN_RECORD) $(patsubst %,$B/bench/%.o,bench_train bench_scale recorder phases): \
        FPFLAGS = $(BENCH_FREE)
$B/bench/bench_train: $B/bench/bench_train.o $(TRAIN_RECORD) $B/ref-decoder/tool/threads.o \
        $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $(BETWEEN) $^ -o $@ $(LIBS)
# On kitchen where it is, else on a small scene made for the purpose.
KITCHEN = $(wildcard $(TED4_DATA)/kitchen)
TRAIN_SCENE = $(if $(KITCHEN),$(KITCHEN) 2,$B/bench/occluder 1)
$B/bench/occluder: | $B/ted4scene
	$B/ted4scene occluder -o $@ -f --size 320x180

bench-train: $B/bench/bench_train $(if $(KITCHEN),,$B/bench/occluder)
	$(KEEP) bench/train.md $B/bench/bench_train $(TRAIN_SCENE)

# How far steps and runs can use many cores, in bench/scale.md: the share outside parallel work,
# and the bounds.
$B/bench/bench_scale: $B/bench/bench_scale.o $(TRAIN_RECORD) $B/bench/recorder.o $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $(BETWEEN) $^ -o $@ $(LIBS)

# ted4enc with its phases told apart by functions that phases.c puts in between.
PHASES = ted4_dataset_load ted4_dataset_verify ted4_header_settle ted4_trainer_init \
        ted4_trainer_restart ted4_gradient_step ted4_branch_run ted4_snapshot_take \
        ted4_snapshot_restore ted4_state_take ted4_state_restore ted4_densify_adjust ted4_mv_seed \
        ted4_activation_begin ted4_stage2_begin ted4_integer_begin ted4_model_search \
        ted4_refine_prior_bits ted4_rd_prune ted4_trainer_distortion ted4_distortion_gradient \
        ted4_export_scene ted4_encode ted4_encode_with_text ted4_trainer_preview ted4_run_log_step \
        ted4_checkpoint_write ted4_verify ted4_file_keep \
        $(foreach l,base v3 v4,ted4_raster_blend_$l ted4_raster_blend_bwd_$l) ted4_threads_init \
        ted4_threads_count ted4_threads_finish
$B/bench/phases: $B/bench/phases.o $B/bench/recorder.o $B/ref-encoder/tool/ted4enc.o \
        $(ENC_TOOL:%.c=$B/%.o) $(DEC_TOOL:%.c=$B/%.o) $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $(PHASES:%=-Wl,--wrap=%) $^ -o $@ $(LIBS)

# Minutes, on one core.
bench-scale: $B/bench/bench_scale $B/bench/phases $B/ted4scene $(if $(KITCHEN),,$B/bench/occluder)
	$(KEEP) bench/scale.md sh bench/scale.sh $B $(firstword $(TRAIN_SCENE))

# Peak memory of training a large scene, in bench/memory.md: hours. MEMORY_RUNS names some of its
# runs.
bench-memory: $B/ted4enc $B/ted4scene
	TED4_BUILD=$B bench/memory.sh $(MEMORY_RUNS)

.PHONY: bench-raster bench-seeding bench-render bench-train bench-scale bench-memory

# Programs on the decoded file: what the integer entropy model and the range coder cost; how long
# anchors live. rate_check is compiled as freely as it may be, for it measures the speed of
# floating-point networks beside the integer kernels.
BENCH_FILE = rate_check spans
$B/bench/bench_decode.o: FPFLAGS = $(BENCH_FREE)
$B/bench/rate_check.o: FPFLAGS = $(FREE) -ffp-contract=fast -march=native
$(BENCH_FILE:%=$B/bench/%) $B/bench/bench_decode: $B/bench/%: $B/bench/%.o \
        $(DEC_TOOL:%.c=$B/%.o) $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $(filter %.o,$^) $(filter %.a,$^) -o $@ $(LIBS)
$B/bench/spans: $(patsubst %,$B/bench/%.o,spans_view spans_where spans_failed open_decoded)

# What the stability lab measures on a file.
LAB_FACTS = lab_facts open_decoded lab_failed lab_views lab_tracks lab_anchors lab_symbols lab_log
$B/bench/lab_facts: $(LAB_FACTS:%=$B/bench/%.o) $B/ref-encoder/tool/sheet.o \
        $(DEC_TOOL:%.c=$B/%.o) $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $(filter %.o,$^) $(filter %.a,$^) -o $@ $(LIBS)
$B/tests/tools/test_lab_facts: $B/tests/tools/test_lab_facts.o \
        $(patsubst %,$B/bench/%.o,$(filter-out lab_facts lab_failed,$(LAB_FACTS))) \
        $B/ref-encoder/tool/sheet.o \
        $(DEC_TOOL:%.c=$B/%.o) $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ -lcmocka $(LIBS)

# What each means of a smaller file would gain by itself: bench/compact.md.
COMPACT = compact compact_models compact_near compact_positions compact_fit compact_mixing \
        compact_weights lab_views
$B/bench/compact: $(COMPACT:%=$B/bench/%.o) $B/ref-encoder/tool/sheet.o \
        $(DEC_TOOL:%.c=$B/%.o) $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $(filter %.o,$^) $(filter %.a,$^) -o $@ $(LIBS)
$B/tests/tools/test_compact: $(patsubst %,$B/bench/%.o,$(filter compact_%,$(COMPACT)))

# make bench-compact FILE=x.ted4 [SCENE="FOLDER DOWNSCALE"]
bench-compact: $B/bench/compact
	$B/bench/compact $(FILE) $(SCENE)

.PHONY: bench-compact

# Pictures that the pages keep.
$B/bench/to_jpeg: $B/bench/to_jpeg.o
	$(CC) $(LDFLAGS) $^ -o $@ $(LIBS)

$B/tests/tools/test_rate_check: | $(PROGS) $B/bench/rate_check

# make rate-check FILE=x.ted4
rate-check: $B/bench/rate_check
	$B/bench/rate_check $(FILE)

# How fast decoding is, in bench/decode.md: make bench-decode FILE="x.ted4 ..."
bench-decode: $B/bench/bench_decode
	$(KEEP) bench/decode.md $B/bench/bench_decode $(FILE)

.PHONY: rate-check bench-decode

# The evidence: all runs of bench/sweep.txt whose row in bench/sweep.csv is missing or stale (days;
# resumable: bench/sweep.sh does parts of it); `make report` writes bench/report.md with its charts
# from the rows that are there.
sweep: all $(BENCH_FILE:%=$B/bench/%) $B/bench/to_jpeg
	TED4_BUILD=$B TED4_DATA=$(TED4_DATA) bench/sweep.sh

# Only the runs that show real scenes.
real: all $(BENCH_FILE:%=$B/bench/%) $B/bench/to_jpeg
	TED4_BUILD=$B TED4_DATA=$(TED4_DATA) bench/sweep.sh real
	python3 -m bench.pages report

report:
	python3 -m bench.pages report

.PHONY: sweep real report

# The stability lab: the runs of bench/stability.txt whose row in bench/stability.csv is missing or
# stale (hours; resumable), then bench/stability.md with its charts.
stability: all $B/bench/lab_facts $B/bench/to_jpeg
	TED4_BUILD=$B TED4_DATA=$(TED4_DATA) bench/stability.sh
	python3 -m bench.pages stability

.PHONY: stability

# Scenes as other people write them: the runs of bench/zoo.txt whose row in bench/zoo.csv is missing
# or stale (an hour; resumable), then bench/zoo.md.
$B/bench/zoo_masks: $B/bench/zoo_masks.o
	$(CC) $(LDFLAGS) $^ -o $@ $(LIBS)

$B/tests/tools/test_zoo: | $(PROGS) $B/bench/zoo_masks

zoo: all $B/bench/zoo_masks
	TED4_BUILD=$B TED4_DATA=$(TED4_DATA) bench/zoo.sh zoo long
	TED4_BUILD=$B TED4_DATA=$(TED4_DATA) bench/zoo.sh --jobs 1 --threads 0 alone
	python3 -m bench.pages zoo

.PHONY: zoo

# How much model is chosen: the runs of bench/capacity.txt whose row in bench/capacity.csv is
# missing or stale (hours; resumable), then bench/capacity.md.
capacity: all
	TED4_BUILD=$B TED4_DATA=$(TED4_DATA) bench/capacity.sh
	python3 -m bench.pages capacity

.PHONY: capacity

# Files of profile Compact against those before: the runs of bench/bd_rate.txt whose row in
# bench/bd_rate.csv is missing or stale (an hour; resumable), then bench/bd_rate.md.
bd-rate: all
	TED4_BUILD=$B TED4_DATA=$(TED4_DATA) bench/bd_rate.sh
	python3 -m bench.pages bd_rate

.PHONY: bd-rate

# The trainings of bench/held_out.md that no other table has: the runs of bench/held_out.txt whose
# row in bench/held_out.csv is missing or stale (hours; resumable). The page is written by hand.
held-out: all $B/bench/zoo_masks
	TED4_BUILD=$B TED4_DATA=$(TED4_DATA) bench/held_out.sh

.PHONY: held-out

# The same training everywhere: a small scene trained by the builds of bench/machines.txt whose row
# in bench/machines.csv is missing or stale, and the table in bench/machines.md. Builds whose tools
# are missing are skipped, which is said; on Debian for x86-64, deps-cross-train installs them.
cross-train: $B/ted4scene
	TED4_BUILD="$(abspath $B)" bench/machines.sh

DEPS_CROSS_TRAIN = clang-14 libomp-14-dev gcc-aarch64-linux-gnu libc6-dev-arm64-cross
DEPS_AARCH64 = libpng-dev:arm64 libjpeg62-turbo-dev:arm64 libjansson-dev:arm64 libxxhash-dev:arm64 \
        zlib1g-dev:arm64
deps-cross-train: deps
	@$(call INSTALL_DEBIAN,$(DEPS_CROSS_TRAIN))
	@command -v qemu-aarch64-static >/dev/null || command -v qemu-aarch64 >/dev/null || \
	    { $(call INSTALL_DEBIAN,qemu-user); }
	@dpkg --print-foreign-architectures | grep -qx arm64 || \
	    { $(SUDO) dpkg --add-architecture arm64 && $(SUDO) apt-get update -q; }
	@$(call INSTALL_DEBIAN,$(DEPS_AARCH64))

# Instructions of a training step by NEON and by AVX2, counted under qemu, in bench/machines.md.
$B/bench/count_instructions.so: bench/count_instructions.c
	@mkdir -p $(@D)
	$(CC) -O2 $(WARN) -Wno-missing-prototypes -shared -fPIC $< -o $@
bench-instructions: $B/bench/count_instructions.so $B/ted4scene $B/ted4enc
	$(MAKE) B=$B/aarch64 CC=aarch64-linux-gnu-gcc LDFLAGS=-static $B/aarch64/ted4enc
	TED4_BUILD="$(abspath $B)" bench/instructions.sh

.PHONY: cross-train deps-cross-train bench-instructions

# Sweeps by GNU parallel and by job arrays of Slurm against one process, with kills: ten minutes.
# The result is kept in bench/cluster.md if nothing was skipped.
CLUSTER_TESTS = $(addprefix $B/tests/cluster/,merges sweeps)
test-cluster: $(PROGS) $(BENCH_FILE:%=$B/bench/%) $B/bench/to_jpeg $(CLUSTER_TESTS)
	@TED4_BUILD="$(abspath $B)" sh tests/run.sh $(CLUSTER_TESTS)
	@grep -q '^skipped' $(CLUSTER_TESTS:%=%.log) || \
	    $(KEEP) bench/cluster.md sed -n 's/^result: //p' $(CLUSTER_TESTS:%=%.log)

DEPS_CLUSTER = parallel slurmctld slurmd slurm-client munge
deps-cluster: deps
	@$(call INSTALL_DEBIAN,$(DEPS_CLUSTER))

.PHONY: test-cluster deps-cluster

# Programs that measure; tests build them, so that none breaks unseen.
BENCH_PROGRAMS = $(addprefix $B/bench/,bench_raster bench_render bench_train bench_scale \
                 bench_decode rate_check spans lab_facts compact phases to_jpeg zoo_masks)
test-programs: $(BENCH_PROGRAMS)
