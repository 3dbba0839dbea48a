# The second decoder; included by the Makefile.
$B/tests/test_reader: | $B/ted4conf $B/ted4dec

# Both decoders on streams drawn for the purpose, whole and broken: make reader-compare SEEDS=FIRST:END
SEEDS ?= 0:200
reader-compare: $B/ted4dec
	python3 conformance/reader/compare.py --decoder $B/ted4dec --seeds $(SEEDS) --broken 20 --keep $B
# The second decoder against all vectors; verdict page in out/.
reader-conformance: $B/ted4conf
	@mkdir -p out
	$B/ted4conf run --once --timeout 120 --memory 0 -d 'python3 $(CURDIR)/conformance/reader/reader.py' --json out/reader.json --html out/reader.html

.PHONY: reader-compare reader-conformance
