# The second decoder; included by the Makefile.
$B/tests/tools/test_reader: | $B/ted4conf $B/ted4dec

# Both decoders on streams drawn for the purpose, whole and broken:
# make reader-compare SEEDS=FIRST:END
SEEDS ?= 0:200
reader-compare: $B/ted4dec
	python3 conformance/reader/compare.py --decoder $B/ted4dec --seeds $(SEEDS) \
	    --broken 20 --keep $B
# The second decoder against all vectors, those made on demand too. Each of the two largest takes
# 2.8 GiB; READER_FILES=--demand leaves out what is large. Verdict page in out/. READER_TIMEOUT:
# seconds a vector, for busy machines.
READER_FILES   ?= --large
READER_TIMEOUT ?= 600
reader-conformance: $B/ted4conf
	@mkdir -p out
	$B/ted4conf run $(READER_FILES) --once --timeout $(READER_TIMEOUT) --memory 0 \
	    -d 'python3 $(CURDIR)/conformance/reader/reader.py' \
	    --json out/reader.json --html out/reader.html

.PHONY: reader-compare reader-conformance
