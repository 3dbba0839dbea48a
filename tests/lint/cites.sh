#!/bin/sh
# Files cite only this repository and the paper, not notes, plans and lists of work that readers do
# not have. The pages of bench/ that programs write are covered by these programs.
export LC_ALL=C
words="[Aa]lgorithm facts|\(decisions\b|\bdecisions:? [0-9]|project's issue"
{
    grep -rnE "$words" --include='*.[ch]' --include='*.def' --include='*.sh' --include='*.awk' \
        --include='*.py' --include='*.mk' --include=Makefile \
        --include=README.md --exclude=cites.sh Makefile README.md ref-decoder ref-encoder \
        conformance tests fuzz bench tools
    grep -nE "$words" doc/*.md
} | sed 's/$/   (cites what is not here)/' | grep . && exit 1
exit 0
