/* ted4conf.c - the program of the conformance suite: makes the vectors, runs decoders on them, and
 * measures their coverage.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "cover.h"
#include "encoder.h"
#include "gen.h"
#include "mutants.h"
#include "replay.h"
#include "run.h"
#include "ted4.h"
#include "tool/arguments.h"
#include "tool/cli.h"
#include "tool/threads.h"

enum { USAGE = 3 };

static int usage(const char *why)
{
    fprintf(stderr, "ted4conf: %s (see --help)\n", why);
    return USAGE;
}

enum {
    GEN_SUITE,
    GEN_OUTPUT,
    GEN_ONLY,
    GEN_VERIFY,
    GEN_DEMAND,
    GEN_LARGE,
    GEN_HELP,
    GEN_VERSION,
    GEN_OPTIONS
};

static const ted4_argument gen_table[GEN_OPTIONS] = {
    [GEN_SUITE] = { 's', "suite", "DIR", "folder with recipes/ and vectors/. Default conformance" },
    [GEN_OUTPUT] = { 'o', "output", "DIR",
                     "write vectors and SUITE.json there. Default: into the suite" },
    [GEN_ONLY] = { 0, "only", "ID", "only vectors whose id begins so" },
    [GEN_VERIFY] = { 0, "verify", NULL, "write nothing; compare with what is there" },
    [GEN_DEMAND] = { 0, "demand", NULL, "also write the files that are made on demand only" },
    [GEN_LARGE] = { 0, "large", NULL, "also make what is large by nature: minutes, gigabytes" },
    [GEN_HELP] = TED4_ARGUMENT_HELP,
    [GEN_VERSION] = TED4_ARGUMENT_VERSION,
};

static int gen(int argc, char **argv)
{
    static const ted4_command command = {
        "ted4conf gen",
        "[options]",
        "Makes all vectors from their recipes.",
        gen_table,
        GEN_OPTIONS,
        "Exit codes: 0 fine, 1 a vector is not as expected, 3 usage or output.\n",
        NULL
    };
    conf_gen_options o = { .suite = "conformance" };
    const char *value;

    for (int i; (i = ted4_arguments_next(&command, argc, argv, &value)) != TED4_ARGUMENTS_END;)
        switch (i) {
        case TED4_ARGUMENTS_BAD: return USAGE;
        case TED4_ARGUMENTS_DONE: return 0;
        case GEN_SUITE: o.suite = value; break;
        case GEN_OUTPUT: o.output = value; break;
        case GEN_ONLY: o.only = value; break;
        case GEN_VERIFY: o.verify = 1; break;
        case GEN_LARGE: o.large = 1; break;
        default: o.demand = 1;
        }
    return optind < argc ? usage("gen takes no operand") : conf_gen(&o);
}

enum {
    RUN_SUITE,
    RUN_DECODER,
    RUN_LIST,
    RUN_JOBS,
    RUN_TIMEOUT,
    RUN_MEMORY,
    RUN_ONCE,
    RUN_SECOND,
    RUN_DEMAND,
    RUN_LARGE,
    RUN_JSON,
    RUN_JUNIT,
    RUN_HTML,
    RUN_QUIET,
    RUN_HELP,
    RUN_VERSION,
    RUN_OPTIONS
};

static const ted4_argument run_table[RUN_OPTIONS] = {
    [RUN_SUITE] = { 's', "suite", "DIR",
                    "folder with SUITE.json and vectors/. Default conformance" },
    [RUN_DECODER] = { 'd', "decoder", "CMD",
                      "the decoder, as a shell would run it; arguments of the contract follow "
                      "it" },
    [RUN_LIST] = { 'l', "list", "FILE", "only the vectors that it names, one per line" },
    [RUN_JOBS] = { 'j', "jobs", "N", "runs at a time. Default 2" },
    [RUN_TIMEOUT] = { 't', "timeout", "SECONDS",
                      "for one run; then its whole process group is ended. Default 20" },
    [RUN_MEMORY] = { 0, "memory", "MIB",
                     "address space of a run; 0: no bound (sanitizers need that). Default 2048" },
    [RUN_ONCE] = { 0, "once", NULL, "run each vector once, not twice" },
    [RUN_SECOND] = { 0, "second", "NAME=VALUE",
                     "environment of the second run: other kernels, other threads" },
    [RUN_DEMAND] = { 0, "demand", NULL, "also what is made on demand" },
    [RUN_LARGE] = { 0, "large", NULL,
                    "also what is made on demand and large by nature: minutes, gigabytes" },
    [RUN_JSON] = { 0, "json", "FILE", "write results" },
    [RUN_JUNIT] = { 0, "junit", "FILE", "write results as JUnit XML" },
    [RUN_HTML] = { 0, "html", "FILE", "write a page with the verdict" },
    [RUN_QUIET] = { 'q', "quiet", NULL, "only the closing line" },
    [RUN_HELP] = TED4_ARGUMENT_HELP,
    [RUN_VERSION] = TED4_ARGUMENT_VERSION,
};

/* name: of the option. Ends the program if the text is no such number. */
static int64_t number(const char *name, const char *text, int64_t low, int64_t high)
{
    int64_t n;

    if (ted4_arguments_number(text, low, high, &n) != 0)
        exit(ted4_arguments_bad_number("ted4conf", name, text, low, high));
    return n;
}

/* Ends the program if the text does not set a variable. */
static const char *variable(const char *text)
{
    const char *const is = strchr(text, '=');

    if (is == NULL || is == text)
        exit(ted4_arguments_bad("ted4conf", "second", text, "NAME=VALUE"));
    return text;
}

static int run(int argc, char **argv)
{
    static const ted4_command command = {
        "ted4conf run",
        "--decoder 'CMD' [options]",
        "Drives a decoder through the suite by the contract of conformance/README.md.",
        run_table,
        RUN_OPTIONS,
        "Exit codes: 0 conforms, 1 does not, 3 usage.\n",
        NULL
    };
    conf_run_options o = {
        .suite = "conformance", .jobs = 2, .timeout = 20, .memory = (uint64_t)2048 << 20
    };
    const char *value;

    for (int i; (i = ted4_arguments_next(&command, argc, argv, &value)) != TED4_ARGUMENTS_END;)
        switch (i) {
        case TED4_ARGUMENTS_BAD: return USAGE;
        case TED4_ARGUMENTS_DONE: return 0;
        case RUN_SUITE: o.suite = value; break;
        case RUN_DECODER: o.decoder = value; break;
        case RUN_LIST: o.list = value; break;
        case RUN_JOBS: o.jobs = (int)number("jobs", value, 1, 200); break;
        case RUN_TIMEOUT: o.timeout = (double)number("timeout", value, 1, 86400); break;
        case RUN_MEMORY: o.memory = (uint64_t)number("memory", value, 0, 1 << 24) << 20; break;
        case RUN_ONCE: o.once = 1; break;
        case RUN_SECOND: o.second = variable(value); break;
        case RUN_DEMAND: o.demand = 1; break;
        case RUN_LARGE: o.demand = o.large = 1; break;
        case RUN_JSON: o.json = value; break;
        case RUN_JUNIT: o.junit = value; break;
        case RUN_HTML: o.html = value; break;
        default: o.quiet = 1;
        }
    if (o.decoder == NULL || optind < argc)
        return usage("run takes --decoder and no operand");
    if (o.once && o.second != NULL)
        return usage("--second: goes without --once, which leaves the second run out");
    return conf_run(&o);
}

enum { ENCODE_ENCODER, ENCODE_PRESET, ENCODE_TIMEOUT, ENCODE_HELP, ENCODE_VERSION, ENCODE_OPTIONS };

static const ted4_argument encode_table[ENCODE_OPTIONS] = {
    [ENCODE_ENCODER] = { 'e', "encoder", "CMD",
                         "the encoder, as a shell would run it; arguments of the contract come "
                         "behind it" },
    [ENCODE_PRESET] = { 0, "preset", "NAME", "passed on" },
    [ENCODE_TIMEOUT] = { 't', "timeout", "SECONDS",
                         "then its whole process group is ended. Default 86400" },
    [ENCODE_HELP] = TED4_ARGUMENT_HELP,
    [ENCODE_VERSION] = TED4_ARGUMENT_VERSION,
};

static int encode(int argc, char **argv)
{
    static const ted4_command command = {
        "ted4conf encode",
        "--encoder 'CMD' SCENE [options]",
        "Has an encoder make a file, and judges it by the contract of conformance/README.md.",
        encode_table,
        ENCODE_OPTIONS,
        "Exit codes: 0 conforms, 1 does not, 3 usage.\n",
        NULL
    };
    conf_encode_options o = { .timeout = 86400 };
    const char *value;

    for (int i; (i = ted4_arguments_next(&command, argc, argv, &value)) != TED4_ARGUMENTS_END;)
        switch (i) {
        case TED4_ARGUMENTS_BAD: return USAGE;
        case TED4_ARGUMENTS_DONE: return 0;
        case ENCODE_ENCODER: o.encoder = value; break;
        case ENCODE_PRESET: o.preset = value; break;
        default: o.timeout = (double)number("timeout", value, 1, 86400);
        }
    if (o.encoder == NULL || optind + 1 != argc)
        return usage("encode takes --encoder and one scene");
    o.scene = argv[optind];
    return conf_encode(&o);
}

enum {
    COVER_SUITE,
    COVER_SPEC,
    COVER_JSON,
    COVER_HTML,
    COVER_VERBOSE,
    COVER_HELP,
    COVER_VERSION,
    COVER_OPTIONS
};

static const ted4_argument cover_table[COVER_OPTIONS] = {
    [COVER_SUITE] = { 's', "suite", "DIR", "folder with vectors/. Default conformance" },
    [COVER_SPEC] = { 0, "spec", "DIR",
                     "folder of the specification, for its index of rules. Default spec" },
    [COVER_JSON] = { 0, "json", "FILE", "write what is reached and what is not" },
    [COVER_HTML] = { 0, "html", "FILE", "the same as a page" },
    [COVER_VERBOSE] = { 'v', "verbose", NULL, "also say which vector reaches what" },
    [COVER_HELP] = TED4_ARGUMENT_HELP,
    [COVER_VERSION] = TED4_ARGUMENT_VERSION,
};

static int cover(int argc, char **argv)
{
    static const ted4_command command = {
        "ted4conf cover",
        "[options]",
        "Counts what the vectors reach: rules, errors, values, pairs, tables, extremes.",
        cover_table,
        COVER_OPTIONS,
        "Exit codes: 0 everything is reached, 1 not, 3 usage.\n",
        NULL
    };
    conf_cover_options o = { "conformance", "spec", NULL, NULL, 0 };
    const char *value;

    for (int i; (i = ted4_arguments_next(&command, argc, argv, &value)) != TED4_ARGUMENTS_END;)
        switch (i) {
        case TED4_ARGUMENTS_BAD: return USAGE;
        case TED4_ARGUMENTS_DONE: return 0;
        case COVER_SUITE: o.suite = value; break;
        case COVER_SPEC: o.spec = value; break;
        case COVER_JSON: o.json = value; break;
        case COVER_HTML: o.html = value; break;
        default: o.verbose = 1;
        }
    return optind < argc ? usage("cover takes no operand") : conf_cover_run(&o);
}

enum {
    REPLAY_SUITE,
    REPLAY_LIST,
    REPLAY_STOP,
    REPLAY_NAMES,
    REPLAY_WAYS,
    REPLAY_THREADS,
    REPLAY_VALIDATE,
    REPLAY_HELP,
    REPLAY_VERSION,
    REPLAY_OPTIONS
};

static const ted4_argument replay_table[REPLAY_OPTIONS] = {
    [REPLAY_SUITE] = { 's', "suite", "DIR", "folder with vectors/. Default conformance" },
    [REPLAY_LIST] = { 'l', "list", "FILE", "only the vectors that it names, one per line" },
    [REPLAY_STOP] = { 0, "stop", NULL, "at the first failure" },
    [REPLAY_NAMES] = { 0, "names", NULL, "say each vector's id before its turn" },
    [REPLAY_WAYS] = { 0, "ways", NULL,
                      "also with threads, with a trace, without options: nothing may change" },
    [REPLAY_THREADS] = { 'j', "threads", "N",
                         "also decode and query on N threads at once. Default 1" },
    [REPLAY_VALIDATE] = { 0, "validate", NULL, "also ask our validator" },
    [REPLAY_HELP] = TED4_ARGUMENT_HELP,
    [REPLAY_VERSION] = TED4_ARGUMENT_VERSION,
};

static int replay(int argc, char **argv)
{
    static const ted4_command command = { "ted4conf replay",
                                          "[options]",
                                          "Our own decoder against the suite, in one process.",
                                          replay_table,
                                          REPLAY_OPTIONS,
                                          "Exit codes: 0 all pass, 1 not, 3 usage or no vectors.\n",
                                          NULL };
    conf_replay_options o = { .suite = "conformance" };
    const char *value;

    for (int i; (i = ted4_arguments_next(&command, argc, argv, &value)) != TED4_ARGUMENTS_END;)
        switch (i) {
        case TED4_ARGUMENTS_BAD: return USAGE;
        case TED4_ARGUMENTS_DONE: return 0;
        case REPLAY_SUITE: o.suite = value; break;
        case REPLAY_LIST: o.list = value; break;
        case REPLAY_STOP: o.stop = 1; break;
        case REPLAY_NAMES: o.names = 1; break;
        case REPLAY_WAYS: o.ways = 1; break;
        case REPLAY_THREADS: o.threads = (int)number("threads", value, 0, TED4_MAX_THREADS); break;
        default: o.validate = 1;
        }
    return optind < argc ? usage("replay takes no operand") : conf_replay(&o);
}

enum {
    MUTANTS_SUITE,
    MUTANTS_VECTORS,
    MUTANTS_BUILD,
    MUTANTS_COMPILE,
    MUTANTS_FLAGS,
    MUTANTS_LIBRARIES,
    MUTANTS_ONLY,
    MUTANTS_JOBS,
    MUTANTS_TIMEOUT,
    MUTANTS_CHECK,
    MUTANTS_HELP,
    MUTANTS_VERSION,
    MUTANTS_OPTIONS
};

static const ted4_argument mutants_table[MUTANTS_OPTIONS] = {
    [MUTANTS_SUITE] = { 's', "suite", "DIR",
                        "folder with mutants.list and vectors/. Default conformance" },
    [MUTANTS_VECTORS] = { 0, "vectors", "DIR",
                          "folder whose vectors/ is used, with what is made on demand. Default: "
                          "the suite" },
    [MUTANTS_BUILD] = { 'b', "build", "DIR",
                        "a build whose objects are linked with the changed ones. Default build" },
    [MUTANTS_COMPILE] = { 0, "compile", "CMD",
                          "compiler and flags, those of the decoder; needed when something is to "
                          "be run" },
    [MUTANTS_FLAGS] = { 0, "flags", "SUFFIX=FLAGS",
                        "flags for sources with this suffix; may be given several times" },
    [MUTANTS_LIBRARIES] = { 0, "libraries", "LIBS", "after the objects when linking" },
    [MUTANTS_ONLY] = { 0, "only", "ID", "mutants whose id begins with ID" },
    [MUTANTS_JOBS] = { 'j', "jobs", "N", "mutants at a time. Default 1" },
    [MUTANTS_TIMEOUT] = { 't', "timeout", "SECONDS", "for one mutant's replay. Default 300" },
    [MUTANTS_CHECK] = { 0, "check", NULL,
                        "run and write nothing; do the lists fit the sources, and how many results "
                        "hold?" },
    [MUTANTS_HELP] = TED4_ARGUMENT_HELP,
    [MUTANTS_VERSION] = TED4_ARGUMENT_VERSION,
};

static int mutants(int argc, char **argv)
{
    static const ted4_command command = {
        "ted4conf mutants",
        "[options]",
        "Seeded faults in the decoder, which the vectors have to find (make "
        "conformance-mutants).",
        mutants_table,
        MUTANTS_OPTIONS,
        "Exit codes: 0 enough are killed, 1 not, 3 usage, a list that does not fit the\n"
        "sources, or an unchanged decoder that does not pass.\n",
        NULL
    };
    conf_mutant_options o = { .suite = "conformance",
                              .build = "build",
                              .libraries = "-lpng -ljpeg -ljansson -lxxhash -lz -lm",
                              .jobs = 1,
                              .timeout = 300 };
    int n_flags = 0;
    const char *value;

    for (int i; (i = ted4_arguments_next(&command, argc, argv, &value)) != TED4_ARGUMENTS_END;)
        switch (i) {
        case TED4_ARGUMENTS_BAD: return USAGE;
        case TED4_ARGUMENTS_DONE: return 0;
        case MUTANTS_SUITE: o.suite = value; break;
        case MUTANTS_VECTORS: o.vectors = value; break;
        case MUTANTS_BUILD: o.build = value; break;
        case MUTANTS_COMPILE: o.compile = value; break;
        case MUTANTS_FLAGS:
            if (n_flags == CONF_MUTANT_FLAGS)
                return usage("--flags: too many");
            o.flags[n_flags++] = value;
            break;
        case MUTANTS_LIBRARIES: o.libraries = value; break;
        case MUTANTS_ONLY: o.only = value; break;
        case MUTANTS_JOBS: o.jobs = (int)number("jobs", value, 1, 64); break;
        case MUTANTS_CHECK: o.check = 1; break;
        default: o.timeout = (double)number("timeout", value, 1, 86400);
        }
    return optind < argc ? usage("mutants takes no operand") : conf_mutants(&o);
}

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *text;
} commands[] = {
    { "gen", gen, "make all vectors from their recipes" },
    { "run", run, "drive a decoder through the suite" },
    { "encode", encode, "have an encoder make a file, and judge it" },
    { "cover", cover, "count what the vectors reach" },
    { "replay", replay, "our own decoder against the suite, in this process" },
    { "mutants", mutants, "seed faults into the decoder and see whether the vectors find them" },
};

static void help(FILE *f)
{
    fputs("usage: ted4conf COMMAND [options]      (COMMAND --help tells more; --version)\n", f);
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
        fprintf(f, "  %-8s %s\n", commands[i].name, commands[i].text);
}

static int dispatch(int argc, char **argv)
{
    if (argc < 2 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        help(argc < 2 ? stderr : stdout);
        return argc < 2 ? USAGE : 0;
    }
    if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0) {
        printf("ted4conf %s\n", TED4_VERSION);
        return 0;
    }
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
        if (strcmp(argv[1], commands[i].name) == 0)
            return commands[i].run(argc - 1, argv + 1);
    return usage("no such command");
}

int main(int argc, char **argv)
{
    return ted4_cli_end("ted4conf", dispatch(argc, argv));
}
