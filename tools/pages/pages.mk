# Manual pages and shell completion, from the tables of options from which programs make their help
# text; included by the Makefile. A program that is linked with tools/pages writes its own.
PAGES_OBJ  = $(patsubst %.c,$B/%.o,$(wildcard tools/pages/*.c))
PAGES_LINK = $(CC) -fopenmp $(LDFLAGS) -Wl,--wrap=ted4_arguments_next $^ -o $@ $(LIBS)
PAGES_PROG = $(addprefix $B/pages/,$(DEC_PROG) $(ENC_PROG) ted4conf ted4scene \
             ted4tolerance)

# With -flto in CFLAGS, calls within the file would be settled before --wrap can change them.
$B/ref-decoder/tool/arguments.o: FPFLAGS = $(STRICT) -fno-lto

$(PAGES_PROG): | $B/pages
$B/pages:
	@mkdir -p $@
$(DEC_PROG:%=$B/pages/%): $B/pages/%: $B/ref-decoder/tool/%.o $(PAGES_OBJ) \
        $(DEC_TOOL:%.c=$B/%.o) $(DEC_LIB)
	$(PAGES_LINK)
$(ENC_PROG:%=$B/pages/%): $B/pages/%: $B/ref-encoder/tool/%.o $(PAGES_OBJ) \
        $(ENC_TOOL:%.c=$B/%.o) $(DEC_TOOL:%.c=$B/%.o) $(ENC_LIB)
	$(PAGES_LINK)
$B/pages/ted4conf: $(CONF_OBJ) $(PAGES_OBJ) $(CLASS_T_OBJ) $(ENC_LIB)
	$(PAGES_LINK)
$B/pages/ted4scene: $B/tools/scene/ted4scene.o $(SCENE_SRC:%.c=$B/%.o) $(PAGES_OBJ) \
        $(DEC_TOOL:%.c=$B/%.o) $(ENC_LIB)
	$(PAGES_LINK)

$B/pages/ted4tolerance: $B/conformance/tolerance/ted4tolerance.o $(CLASS_T_OBJ) $(PAGES_OBJ) \
        $(DEC_TOOL:%.c=$B/%.o) $(DEC_LIB)
	$(PAGES_LINK)

$B/pages/written: $(PAGES_PROG) $(wildcard tools/pages/*.sh tools/pages/*.1) CITATION.cff
	sh tools/pages/write.sh $B
	@touch $@
man: $B/pages/written

# What desktops and file(1) need to know the format is in share/ too; see doc/install.md.
SHARE = $(DESTDIR)$(PREFIX)/share
ZSH_COMPLETIONS ?= $(PREFIX)/share/zsh/site-functions
install-pages: man
	install -d "$(SHARE)/man/man1" "$(SHARE)/bash-completion/completions" \
	    "$(DESTDIR)$(ZSH_COMPLETIONS)" "$(SHARE)/fish/vendor_completions.d" \
	    "$(SHARE)/mime/packages" "$(SHARE)/ted4"
	install -m 644 $B/man/*.1 "$(SHARE)/man/man1"
	install -m 644 $B/completion/bash/ted4dec "$(SHARE)/bash-completion/completions"
	for p in $(notdir $(filter-out %/ted4dec,$(PAGES_PROG))); do \
	    ln -sf ted4dec "$(SHARE)/bash-completion/completions/$$p" || exit; done
	install -m 644 $B/completion/zsh/* "$(DESTDIR)$(ZSH_COMPLETIONS)"
	install -m 644 $B/completion/fish/* "$(SHARE)/fish/vendor_completions.d"
	install -m 644 tools/ted4.xml "$(SHARE)/mime/packages"
	install -m 644 tools/ted4.magic "$(SHARE)/ted4"

CONF_COMMANDS = cover encode gen mutants replay run
PAGES_NAMES   = $(notdir $(PAGES_PROG))
uninstall::
	$(call REMOVE,$(PAGES_NAMES:%=%.1) $(CONF_COMMANDS:%=ted4conf-%.1),$(SHARE)/man/man1)
	$(call REMOVE,$(PAGES_NAMES),$(SHARE)/bash-completion/completions)
	$(call REMOVE,_ted4,$(DESTDIR)$(ZSH_COMPLETIONS))
	$(call REMOVE,$(PAGES_NAMES:%=%.fish),$(SHARE)/fish/vendor_completions.d)
	$(call REMOVE,mime/packages/ted4.xml ted4/ted4.magic,$(SHARE))
	$(call REMOVE_FOLDERS,ted4,$(SHARE))

$B/tests/tools/test_manual: | man $(PROGS) $B/ted4conf $B/ted4tolerance
.PHONY: man install-pages
