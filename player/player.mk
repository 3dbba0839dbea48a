# The decoder in WebAssembly, and the JavaScript around it. `make player-wasm` needs clang and lld
# of LLVM 19 (make deps-player) and nothing from npm.
W       = $B/player
WASM_CC = clang-19 --target=wasm32 -nostdlib -ffreestanding -O3 -std=c11 -msimd128 -mbulk-memory \
          -fvisibility=hidden -ffunction-sections -fdata-sections $(STRICT) -fno-math-errno \
          -Wall -Wextra -Werror
# What the C library would give comes from wasm/include; xxHash is one header of the system.
WASM_INC = -isystem player/wasm/include -I$W/inc -Iref-decoder -idirafter /usr/include
WASM_DEC = $(sort $(filter-out %/inflate.c %/validate.c %/finding.c \
           $(wildcard ref-decoder/read/advise*.c \
           ref-decoder/read/collect*.c ref-decoder/kernel/*_avx2.c ref-decoder/kernel/*_avx512.c \
           ref-decoder/kernel/*_vnni.c ref-decoder/kernel/*_neon.c), $(DEC_SRC)))
WASM_SRC = $(WASM_DEC) ref-decoder/tool/budget.c $(sort $(wildcard player/wasm/*.c))
WASM_OBJ = $(WASM_SRC:%.c=$W/%.o)

player-wasm: $W/ted4.wasm
$W/inc/spec/inflate.h: spec/annex-l-deflate.md tests/spec/code.awk
	@mkdir -p $(@D)
	awk -f tests/spec/code.awk $< > $@.new && mv $@.new $@
$W/player/wasm/inflate.o: $W/inc/spec/inflate.h
$W/player/wasm/xxhash.o: SMALL = -Os
$W/%.o: %.c player/player.mk
	@mkdir -p $(@D)
	$(WASM_CC) $(SMALL) $(WASM_INC) -MD -MP -c $< -o $@
$W/ted4.wasm: $(WASM_OBJ)
	wasm-ld-19 --no-entry --gc-sections --strip-all -z stack-size=1048576 -O2 $^ -o $@
	@printf '%s: %s bytes, %s by gzip -9\n' $@ $$(wc -c <$@) $$(gzip -9c $@ | wc -c)

# Through the JavaScript interface, in Node: its tests, and the conformance suite by the driver
# contract. WebAssembly reserves address space, so the runs of the suite have no bound on it.
player-test: $W/ted4.wasm
	TED4_WASM="$(abspath $W/ted4.wasm)" node --test player/test/*.test.mjs
player-conformance: $W/ted4.wasm $B/ted4conf
	TED4_WASM="$(abspath $W/ted4.wasm)" \
	    $B/ted4conf run --decoder 'node player/test/driver.mjs' \
	    --memory 0 --once --timeout 60

# The licences of what the module is made of: BSD-2-Clause asks for their texts beside binaries.
$W/LICENSE: LICENSE /usr/include/xxhash.h player/player.mk
	@mkdir -p $(@D)
	{ cat LICENSE; echo; sed '/\*\//q' /usr/include/xxhash.h; } >$@

# The package for npm. The module and its licences lie beside package.json, where git ignores them.
PACKAGE_SRC = $W/LICENSE $(addprefix player/,package.json README.md) \
              $(wildcard player/src/* player/adapters/*.js player/adapters/*.d.ts)
player-package: $W/ted4.tgz
$W/ted4.tgz: $W/ted4.wasm $(PACKAGE_SRC)
	cp $< $W/LICENSE player
	cd player && npm pack --silent --pack-destination "$(abspath $W)" >"$(abspath $W)/packed"
	mv "$W/$$(cat $W/packed)" $@
DEPS_PLAYER = clang-19 lld-19 nodejs $(if $(shell command -v npm),,npm)
deps-player: deps
	@$(call INSTALL_DEBIAN,$(DEPS_PLAYER))
.PHONY: player-wasm player-test player-conformance player-package deps-player

# The page (page/), by esbuild and the packages that player/package-lock.json pins; they lie in the
# build folder, as do those that only the tests need (player/test/package-lock.json). The licences
# come first in player.js.
NPM      = $W/npm
NPM_TEST = $W/npm-test
ESBUILD  = $(NPM)/node_modules/.bin/esbuild --bundle --minify --format=iife --target=es2022 \
           --log-level=warning
PAGE_LICENCE = $(NPM)/node_modules/playcanvas/LICENSE
PAGE_SRC = $(wildcard player/page/*.js player/src/*.js player/adapters/*.js)
ADAPTERS = $(patsubst %,$W/adapters/%,index.html playcanvas.js spark.js supersplat.js)
player: $(addprefix $W/,index.html style.css player.js ted4.wasm)
$(NPM)/installed: player/package-lock.json
$(NPM_TEST)/installed: player/test/package-lock.json
$(NPM)/installed $(NPM_TEST)/installed:
	@mkdir -p $(@D)
	cp $< $(<D)/package.json $(@D)
	cd $(@D) && npm ci --prefer-offline --ignore-scripts --no-audit --no-fund --loglevel=error
	@touch $@
$W/index.html $W/style.css: $W/%: player/page/%
	@mkdir -p $(@D)
	cp $< $@
$W/worker.txt: $(PAGE_SRC) $(NPM)/installed
	NODE_PATH="$(abspath $(NPM)/node_modules)" $(ESBUILD) player/src/worker.js --outfile=$@
$W/player.js: $(PAGE_SRC) $W/worker.txt $W/LICENSE $(NPM)/installed
	NODE_PATH="$(abspath $(NPM)/node_modules)" $(ESBUILD) player/page/main.js \
	    --loader:.txt=text --outfile=$@.new \
	    --alias:worker-text="$(abspath $W/worker.txt)" --log-override:empty-import-meta=silent
	{ sed '1s,^,/*! ,' $W/LICENSE; echo '/*! PlayCanvas:'; cat $(PAGE_LICENCE); echo '*/'; \
	    cat $@.new; } >$@
	@rm $@.new
player-html: player
	node player/export.mjs $W "$(FILE)" "$(OUT)"
.PHONY: player player-html

# The page, and those of the adapters, in Chromium and in Firefox, with a small file that is trained
# for it; what splat-transform makes of that file's exports; the package, and its types by
# TypeScript. Firefox has no WebGL without a display.
T       = $W/test
TEST_PLAYER = TED4_PLAYER="$(abspath $W)" TED4_SCENE="$(abspath $T/occluder.ted4)" \
              TED4_SMALL="$(abspath $T/small.ted4)" \
              TED4_OUT="$(abspath $T)" TED4_PROGRAMS="$(abspath $B)" \
              TED4_MODULES="$(abspath $(NPM_TEST)/node_modules)" \
              TED4_PACKAGE="$(abspath $W/ted4.tgz)"
$W/adapters/index.html: player/adapters/pages/index.html
	@mkdir -p $(@D)
	cp $< $@
$W/adapters/%.js: player/adapters/pages/%.js $(PAGE_SRC) $(wildcard player/adapters/pages/*.js) \
    $(NPM)/installed $(NPM_TEST)/installed
	NODE_PATH="$(abspath $(NPM_TEST)/node_modules)" $(ESBUILD) $< --outfile=$@
test-player: player $(ADAPTERS) $W/ted4.tgz $T/occluder.ted4 $T/small.ted4 $B/ted4dec $B/ted4edit
	$(TEST_PLAYER) node --test player/test/conversions.mjs player/test/package.mjs \
	    player/test/types.mjs
	$(TEST_PLAYER) node --test --test-concurrency=1 player/test/*.browser.mjs
	@mkdir -p $T/firefox
	$(TEST_PLAYER) TED4_BROWSER=firefox TED4_OUT="$(abspath $T/firefox)" \
	    xvfb-run -a -s '-screen 0 1600x1200x24' \
	    node --test --test-concurrency=1 player/test/*.browser.mjs
$T/small.ted4: UNIT = --unit 0.000001
$T/occluder.ted4 $T/small.ted4: $T/%.ted4: | $B/ted4scene $B/ted4enc
	@mkdir -p $T
	$B/ted4scene occluder -o $T/$*-scene -f $(UNIT)
	$B/ted4enc $T/$*-scene -o $@ --preset draft --iterations 800,400 --seed 1 \
	    --cameras -f -q
player-speed: player $B/ted4dec $(NPM_TEST)/installed
	$(TEST_PLAYER) node player/test/speed.mjs $(FILE)
	TED4_WASM="$(abspath $W/ted4.wasm)" TED4_DEC="$(abspath $B/ted4dec)" \
	    node player/test/decode_speed.mjs $(FILE)
deps-test-player: deps-player
	@$(call INSTALL_DEBIAN,chromium firefox-esr xvfb xauth libgl1-mesa-dri libegl1)
.PHONY: test-player player-speed deps-test-player
