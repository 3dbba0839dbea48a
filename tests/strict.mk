# What tests of the strict decoder need beside the libraries; included by the Makefile.
$B/tests/test_lenient: $(patsubst %,$B/fuzz/%.o,mend parse)
$B/tests/test_validate: $(patsubst %,$B/fuzz/%.o,mend parse mutate fields)
