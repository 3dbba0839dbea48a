# What the specification prints, as C: spec/code.h and tables as *.inc, under the build folder, for
# tests/support/spec_model.h and spec_tiers.h.
SPEC_ORDER = 04-notation annex-k-xxh3 annex-l-deflate 05-container 06-header 07-networks \
        08-positions 09-entropy 10-attributes 12-arithmetic 11-reconstruction 13-levels \
        annex-m-pass2
SPEC_CODE  = $(SPEC_ORDER:%=spec/%.md)
SPEC_INC   = $(addprefix $B/inc/spec/,code.h head.inc levels.inc elements.inc)

$B/inc/spec/code.h: $(SPEC_CODE) tests/spec/code.awk
	@mkdir -p $(@D)
	awk -f tests/spec/code.awk $(SPEC_CODE) > $@.new && mv $@.new $@
$B/inc/spec/head.inc: spec/06-header.md tests/spec/head.awk
	@mkdir -p $(@D)
	awk -f tests/spec/head.awk $< > $@.new && mv $@.new $@
$B/inc/spec/levels.inc: spec/13-levels.md tests/spec/levels.awk
	@mkdir -p $(@D)
	awk -f tests/spec/levels.awk $< > $@.new && mv $@.new $@
$B/inc/spec/elements.inc: spec/annex-j-dumps.md tests/spec/elements.awk
	@mkdir -p $(@D)
	awk -f tests/spec/elements.awk $< > $@.new && mv $@.new $@
SPEC_USERS = $(patsubst %.c,$B/%.o,$(wildcard tests/docs/test_*.c)) $B/tests/gen/gen_annex.o
$(SPEC_USERS): $(SPEC_INC)
$(SPEC_USERS): FPFLAGS = $(STRICT) -I$B/inc

# The evaluations of annex E: the printed code, and what sed makes of it.
SPEC_EVALS = exact wide fused reordered
$B/inc/spec/code_exact.h: $B/inc/spec/code.h
	cp $< $@
$B/inc/spec/code_%.h: $B/inc/spec/code.h tests/spec/%.sed
	sed -f tests/spec/$*.sed $< > $@.new && ! cmp -s $@.new $< && mv $@.new $@
$B/tests/spec/eval_%.o: tests/spec/eval.c $B/inc/spec/code_%.h
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) $(STRICT) -I$B/inc -DVARIANT='"spec/code_$*.h"' \
	    -DREAL=$(if $(filter wide,$*),double,float) -DRECORDS=tol_$* -c $< -o $@
$B/tests/docs/test_spec_tolerance: $(SPEC_EVALS:%=$B/tests/spec/eval_%.o)

$B/gen_annex: $B/tests/gen/gen_annex.o $(DEC_TOOL:%.c=$B/%.o) $(ENC_LIB)
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)

# Annexes that programs make. tests/docs/test_spec_annexes.c fails when they are not current.
spec-annexes: $B/gen_annex
	$B/gen_annex a > spec/annex-a-tables.md
	$B/gen_annex b > spec/annex-b-examples.md
	$B/gen_annex c > spec/annex-c-levels.md
	$B/gen_annex h > spec/annex-h-limits.md
	sh tests/lint/spec_rules.sh print > spec/annex-g-rules.md
	sh tests/lint/spec_json.sh print rules > spec/rules.json
	sh tests/lint/spec_json.sh print errors > spec/errors.json
.PHONY: spec-annexes

$B/attest: $B/tests/gen/attest.o $B/libted4dec.a
	$(CC) -fopenmp $(LDFLAGS) $^ -o $@ $(LIBS)

# Functions over all their inputs against the hashes of annex J.9, row by row; takes two minutes of
# one core. Each row has to come.
attest: $B/attest
	@$B/attest | { n=0; while read -r row; do \
	    grep -qxF "$$row" spec/annex-j-dumps.md && echo "as in J.9: $$row" || \
	        { echo "not in J.9: $$row"; exit 1; }; n=$$((n + 1)); done; \
	    of=$$(grep -cE '^\| .* \| [0-9]+ \| `[0-9a-f]{32}` \|$$' spec/annex-j-dumps.md); \
	    echo "$$n of $$of rows"; [ $$n -gt 0 ] && [ $$n -eq $$of ]; }
.PHONY: attest

# The specification as HTML, with an anchor for each rule; needs pandoc (deps-dev).
spec:
	@sh tests/spec/html.sh $B/spec
.PHONY: spec
