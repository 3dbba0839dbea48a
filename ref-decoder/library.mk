# libted4dec as a shared library, and what tells other builds about both libraries. Its symbols are
# those of ref-decoder/libted4dec.symbols; when a function leaves this list, or changes, the number
# behind .so changes.
VERSION = $(shell sed -n 's/^\#define TED4_VERSION *"\(.*\)"$$/\1/p' ref-decoder/ted4.h)
SONAME  = libted4dec.so.1
SHARED  = $B/$(SONAME)
LIBDIR ?= $(PREFIX)/lib
# Inside the library, functions are called directly: nobody may put another one in their place.
# (With protected visibility, programs that are not position independent could not take their
# addresses.)
LIBRARY_FLAGS = -fPIC -fno-semantic-interposition
$(call OBJECTS,$(DEC_SRC)): LIBRARY = $(LIBRARY_FLAGS)

$B/libted4dec.map: ref-decoder/libted4dec.symbols
	@mkdir -p $(@D)
	{ echo 'TED4_1 {'; echo 'global:'; sed 's/$$/;/' $<; echo 'local: *;'; echo '};'; } >$@
$(SHARED): $(call OBJECTS,$(DEC_SRC)) $B/libted4dec.map
	$(CC) -shared $(LDFLAGS) -Wl,-soname,$(SONAME) -Wl,--version-script=$B/libted4dec.map \
	    -Wl,-Bsymbolic-functions \
	    $(filter %.o,$^) -o $@ -lxxhash -lz -lm
library: $(SHARED) $B/libted4dec.a

# Turns a template's @NAME@ into what they are here. Where LIBDIR is below PREFIX, either is named
# relative to the other, so that both may be moved together.
# Paths are no words for make, as they may have spaces: "|" marks where one begins.
BELOW = $(if $(findstring |$(PREFIX)/,|$(LIBDIR)),$(subst |$(PREFIX)/,/,|$(LIBDIR)))
FILL = up=$$(echo '$(BELOW)' | sed 's|/[^/]*|/..|g'); \
    sed 's|@VERSION@|$(VERSION:-dev=)|; s|@PREFIX@|$(PREFIX)|; s|@SONAME@|$(SONAME)|; \
    s|@LIBDIR@|$(if $(BELOW),$${prefix}$(BELOW),$(LIBDIR))|; \
    '"s|@ROOT@|$(if $(BELOW),\$${_ted4_libdir}$$up,$(PREFIX))|"
install-library: library
	install -d "$(DESTDIR)$(LIBDIR)/pkgconfig" "$(DESTDIR)$(LIBDIR)/cmake/ted4" \
	    "$(DESTDIR)$(PREFIX)/include/ted4/base"
	install -m 644 $B/libted4dec.a "$(DESTDIR)$(LIBDIR)"
	install -m 755 $(SHARED) "$(DESTDIR)$(LIBDIR)"
	ln -sf $(SONAME) "$(DESTDIR)$(LIBDIR)/libted4dec.so"
	install -m 644 ref-decoder/ted4.h "$(DESTDIR)$(PREFIX)/include/ted4"
	install -m 644 ref-decoder/base/parallel.h ref-decoder/base/status.h \
	    ref-decoder/base/status.def "$(DESTDIR)$(PREFIX)/include/ted4/base"
	$(FILL) ref-decoder/ted4.pc.in >$B/ted4.pc
	install -m 644 $B/ted4.pc "$(DESTDIR)$(LIBDIR)/pkgconfig"
	for f in ted4-config ted4-config-version; do \
	    $(FILL) ref-decoder/$$f.cmake.in >$B/$$f.cmake && \
	    install -m 644 $B/$$f.cmake "$(DESTDIR)$(LIBDIR)/cmake/ted4" || exit; done
uninstall::
	$(call REMOVE,libted4dec.a $(SONAME) libted4dec.so pkgconfig/ted4.pc \
	    cmake/ted4/ted4-config.cmake cmake/ted4/ted4-config-version.cmake,$(DESTDIR)$(LIBDIR))
	$(call REMOVE,ted4.h base/parallel.h base/status.h \
	    base/status.def,$(DESTDIR)$(PREFIX)/include/ted4)
	$(call REMOVE_FOLDERS,cmake/ted4,$(DESTDIR)$(LIBDIR))
	$(call REMOVE_FOLDERS,ted4/base ted4,$(DESTDIR)$(PREFIX)/include)

# The types behind the symbols, as abidw (Debian: abigail-tools) reads them from debug information;
# tests/tools/test_library.sh compares a build with them. To be made again, on x86-64, by who means
# to change them.
library-abi: install-library
	abidw --no-corpus-path --no-comp-dir-path --no-show-locs --drop-private-types \
	    --exported-interfaces-only --headers-dir "$(DESTDIR)$(PREFIX)/include" \
	    --out-file ref-decoder/libted4dec.abi $(SHARED)

.PHONY: library install-library library-abi
