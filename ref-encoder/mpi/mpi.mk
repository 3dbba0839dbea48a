# ted4enc for several processes, that talk by Open MPI: mpirun -n N $B/ted4enc-mpi SCENE ...
DEPS_MPI = openmpi-bin libopenmpi-dev pkg-config
MPI_CFLAGS = $(patsubst -I%,-isystem %,$(shell pkg-config --cflags ompi-c))
MPI_LIBS   = $(shell pkg-config --libs ompi-c)

mpi: $B/ted4enc-mpi
	@pkg-config --exists ompi-c || { echo 'make mpi: no Open MPI (make deps-mpi)'; exit 1; }

$B/ref-encoder/mpi/%.o: ref-encoder/mpi/%.c $B/how
	@mkdir -p $(@D)
	@pkg-config --exists ompi-c || { echo 'make mpi: no Open MPI (make deps-mpi)'; exit 1; }
	$(CC) $(CFLAGS_ALL) $(STRICT) $(MPI_CFLAGS) -c $< -o $@
$B/ted4enc-mpi: $B/ref-encoder/mpi/ted4enc_mpi.o $(ENC_TOOL:%.c=$B/%.o) $(DEC_TOOL:%.c=$B/%.o) \
        $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS) $(MPI_LIBS)

# Several ranks on this machine; skipped, and said so, where Open MPI is not installed.
RANKS_TEST = $B/tests/cluster/ranks
test-mpi: $B/ted4enc $B/ted4scene $(shell pkg-config --exists ompi-c && echo $B/ted4enc-mpi) \
        $(RANKS_TEST)
	@TED4_BUILD=$(abspath $B) sh tests/run.sh $(RANKS_TEST)

# The time of a step by two ranks against one, for a quiet machine of two cores: some minutes.
bench-mpi: $B/ted4enc $B/ted4enc-mpi
	TED4_BUILD=$B bench/cluster/step_time.sh

deps-mpi: deps
	@$(call INSTALL_DEBIAN,$(DEPS_MPI))

.PHONY: mpi test-mpi bench-mpi deps-mpi
