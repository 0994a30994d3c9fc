# assay - `make help` lists the targets.

VERSION := 0.1.0
SOVERSION := 0
PREFIX  ?= /usr/local
DESTDIR ?=
LIBDIR  ?= $(PREFIX)/lib
BUILD   ?= build/release
CC      ?= cc
CXX     ?= c++
AR      ?= ar
OPT     ?= -O3 -g
SAN     ?=

# What `make deps` installs (Debian 12).
DEPS_BUILD := gcc g++ make libembree-dev libopenexr-dev libtinygltf-dev libsleef-dev \
              librandom123-dev libpng-dev zlib1g-dev libdeflate-dev libjpeg-dev \
              libcjson-dev libmd-dev
DEPS_TEST  := libcmocka-dev clang chromium python3-numpy
DEPS_LINT  := clang-format clang-tidy cppcheck
DEPS_REF   := libflint-arb-dev libflint-dev libmpfr-dev

# Same bits everywhere: no contraction, no fast math, no -march (docs/determinism.md).
override CPPFLAGS += -D_GNU_SOURCE -DASSAY_VERSION='"$(VERSION)"' -Iinclude -Isrc -Itests
WARN     := -Wall -Wextra -Wshadow -Wundef -Wvla -Wpointer-arith -Wcast-align
override CFLAGS += -std=c11 $(OPT) $(WARN) -Wstrict-prototypes -Wmissing-prototypes -ffp-contract=off \
            -fvisibility=hidden -fPIC -pthread $(SAN)
override CXXFLAGS += -std=c++17 $(OPT) $(WARN) -ffp-contract=off -fvisibility=hidden -fPIC $(SAN)
override LDFLAGS += -pthread $(SAN)
override LDLIBS += -lembree3 -lOpenEXRCore -ltinygltf -lsleef -lpng -lz -ldeflate -ljpeg -lcjson -lmd -lm -lstdc++

LIB_C   := $(filter-out src/cli/%,$(wildcard src/*/*.c src/*/*/*.c))
LIB_CXX := $(wildcard src/*/*.cpp)
CLI_C   := $(wildcard src/cli/*.c)
GEN_C   := $(wildcard scenes/gen/*.c)
BENCH_C := $(wildcard tests/bench/*.c)
TABLE_C := $(wildcard tests/tables/*.c)
HELP_C  := $(wildcard tests/support/*.c)
TEST_C  := $(wildcard tests/*/test_*.c)
PAGE    := $(wildcard src/oracle/report/page/*)
LIB_O   := $(LIB_C:%.c=$(BUILD)/%.o) $(LIB_CXX:%.cpp=$(BUILD)/%.o) $(BUILD)/report_page.o
CLI_O   := $(CLI_C:%.c=$(BUILD)/%.o)
GEN_O   := $(GEN_C:%.c=$(BUILD)/%.o)
HELP_O  := $(HELP_C:%.c=$(BUILD)/%.o)
TESTS   := $(TEST_C:%.c=$(BUILD)/%)
TEST_SCRIPTS := $(wildcard tests/*/test_*.sh)
BENCHES := $(BENCH_C:%.c=$(BUILD)/%)
TABLES  := $(TABLE_C:%.c=$(BUILD)/%)
OURS    := $(wildcard include/assay/*.h src/*/*.[ch] src/*/*/*.[ch] src/*/*.cpp scenes/gen/*.[ch] \
             refdata/gen/*.[ch] tests/*/*.[ch])
TOOL_C  := $(wildcard tests/golden/golden_*.c)
GOLDEN_TOOL := $(BUILD)/tests/golden/golden_arrays

.PHONY: all help deps deps-test demo test install uninstall scenes ref ref-update golden \
        golden-check figures layers format lint bench tables mutants check-sanitize check-arm64 fuzz clean
all: $(BUILD)/assay ## build the command

help: ## list the targets
	@sed -n 's/^\([a-z0-9-]*\):.*## /\1\t/p' $(firstword $(MAKEFILE_LIST)) | expand -t 18

# ---- building ----
$(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c $< -o $@

$(BUILD)/%.o: %.cpp
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS) $(CXXFLAGS) -MMD -MP -c $< -o $@

$(BUILD)/report_page.c: $(PAGE)
	@mkdir -p $(@D)
	src/oracle/report/page/embed.sh > $@.tmp && mv $@.tmp $@

$(BUILD)/report_page.o: $(BUILD)/report_page.c
	$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c $< -o $@

$(BUILD)/libassay.a: $(LIB_O)
	@rm -f $@
	$(AR) rcs $@ $^

$(BUILD)/libassay.so: $(LIB_O)
	$(CXX) -shared -Wl,-soname,libassay.so.$(SOVERSION) $(LDFLAGS) $^ $(LDLIBS) -o $@

$(BUILD)/assay: $(CLI_O) $(BUILD)/libassay.a
	$(CXX) $(LDFLAGS) $^ $(LDLIBS) -o $@

# ---- what must be installed: asked for only where it is missing ----
define install_missing
missing=; for p in $(1); do dpkg-query -W -f '$${Status}' $$p 2>/dev/null | grep -q ' installed' \
  || missing="$$missing $$p"; done; \
if [ -z "$$missing" ]; then exit 0; fi; \
if ! command -v apt-get >/dev/null; then \
  echo "This is not Debian. Install what these packages hold, then try again:$$missing" >&2; exit 1; fi; \
sudo=; if [ "$$(id -u)" != 0 ]; then sudo=sudo; command -v sudo >/dev/null || { \
  echo "Not root and no sudo. Have these packages installed:$$missing" >&2; exit 1; }; fi; \
echo "Installing:$$missing"; $$sudo apt-get update -q && \
$$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends $$missing
endef

deps: ## install what building needs (Debian)
	@$(call install_missing,$(DEPS_BUILD))

deps-test: ## install what the tests need (Debian)
	@$(call install_missing,$(DEPS_BUILD) $(DEPS_TEST))

# ---- the two commands ----
MUTANT_ENV = BUILD=$(BUILD) \
   MUTANT_COMPILE="$(CC) $(filter-out -DASSAY_VERSION%,$(CPPFLAGS)) $(CFLAGS)" \
   MUTANT_LINK="$(CXX) $(LDFLAGS)" MUTANT_COMMAND="$(CLI_O)" \
   MUTANT_LIBS="$(HELP_O) $(filter-out %/main.o,$(GEN_O)) $(BUILD)/libassay.a -lcmocka $(LDLIBS)"

DEMO := build/demo
demo: deps ## render our Cornell box two ways, verify one against the other, write a report
	@$(MAKE) --no-print-directory -s -j$$(nproc) all
	@rm -rf $(DEMO); mkdir -p $(DEMO)/cache
	@set -e; draw() { $(BUILD)/assay render scenes/cornell-box/cornell-box.gltf --size 256x256 \
	     --layers color,gbuffer "$$@"; }; \
	 draw --method path --spp 64 -o $(DEMO)/cornell-box.exr --stats $(DEMO)/cornell-box.json \
	   --png $(DEMO)/cornell-box.png --exposure 1; \
	 for n in 4 16; do draw --method path --spp $$n --seed $$n -o $(DEMO)/path-$$n.exr \
	   --stats $(DEMO)/path-$$n.json; done; \
	 draw --method irradiance-cache --spp 16 --a 0.25 --theta-strata 10 --phi-strata 32 \
	   --dump $(DEMO)/cache/irradiance-cache -o $(DEMO)/cache/irradiance-cache.exr \
	   --stats $(DEMO)/cache/irradiance-cache.json
	@echo "Is the cache's image the path tracer's, within 10 percent in every 64 x 64 pixels?"
	@$(BUILD)/assay verify $(DEMO)/cache/irradiance-cache.exr --reference $(DEMO)/cornell-box.exr \
	   --allow 0.1 --tile 64 --json $(DEMO)/cache/irradiance-cache.verdict.json || [ $$? -le 2 ]
	@$(BUILD)/assay report $(DEMO)/cache/irradiance-cache $(DEMO)/path-4.exr $(DEMO)/path-16.exr \
	   --reference $(DEMO)/cornell-box.exr -o $(DEMO)/report.html
	@echo "  $(DEMO)/cornell-box.png   to look at"
	@echo "  $(DEMO)/cornell-box.exr   linear radiance, variance, G-buffer: all layers"
	@echo "  $(DEMO)/cache             the same by irradiance caching, with its records"
	@echo "  $(DEMO)/report.html       both side by side, where they differ, and why: open it in a browser"
	@echo "Next: $(BUILD)/assay render --help"

# A backend that shares nothing with assay but a format: without its headers and its library.
BACKEND_C       := $(wildcard tests/backends/*.c)
BACKEND_O       := $(BACKEND_C:tests/backends/%.c=$(BUILD)/backend/%.o)
BACKEND_COMPILE := $(CC) -D_GNU_SOURCE -std=c11 $(OPT) $(WARN) -Wstrict-prototypes \
                   -Wmissing-prototypes -ffp-contract=off $(SAN)
BACKEND_LIBS    := -lcjson -lmd -lOpenEXRCore -lm
BACKEND_ENV     = BACKEND_COMPILE="$(BACKEND_COMPILE)" BACKEND_LIBS="$(BACKEND_LIBS)" \
                  BACKEND_OBJECTS=$(BUILD)/backend

$(BUILD)/backend/%.o: tests/backends/%.c
	@mkdir -p $(@D)
	$(BACKEND_COMPILE) -MMD -MP -c $< -o $@

$(BUILD)/backend/backend: $(BACKEND_O)
	$(BACKEND_COMPILE) $^ $(BACKEND_LIBS) -o $@

test: deps-test ## build and run all tests
	@$(MAKE) --no-print-directory -s -j$$(nproc) all $(TESTS) $(BUILD)/make_scenes \
	   $(BUILD)/backend/backend $(GOLDEN_TOOL)
	@$(MUTANT_ENV) $(BACKEND_ENV) ASSAY_BIN=$(BUILD)/assay tests/tools/run.sh $(TEST_SCRIPTS) $(TESTS)

MUTANT_LISTS = tests/mutants/*.txt
mutants: deps-test ## break the source on purpose, also where `make test` does not
	@$(MAKE) --no-print-directory -s -j$$(nproc) all $(TESTS)
	@for list in $(MUTANT_LISTS); do $(MUTANT_ENV) MUTANTS=$$list \
	   tests/tools/run.sh tests/mutants/test_mutants.sh || exit 1; done

# ---- tests ----
$(BUILD)/tests/bench/%: $(BUILD)/tests/bench/%.o $(BUILD)/libassay.a
	$(CXX) $(LDFLAGS) $^ $(LDLIBS) -o $@

$(BUILD)/tests/fuzz/%: $(BUILD)/tests/fuzz/%.o $(BUILD)/libassay.a
	$(CXX) $(LDFLAGS) $(FUZZ_LINK) $^ $(LDLIBS) -o $@

$(BUILD)/tests/%: $(BUILD)/tests/%.o $(HELP_O) $(filter-out %/main.o,$(GEN_O)) $(BUILD)/libassay.a
	$(CXX) $(LDFLAGS) $^ -lcmocka $(LDLIBS) -o $@

check-sanitize: deps-test ## the tests under ASan and UBSan
	@$(MAKE) --no-print-directory test BUILD=build/sanitize CC=clang CXX=clang++ OPT="-O1 -g" \
	   SAN="-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer" \
	   TEST_SCRIPTS="$(filter-out %/test_same_bits.sh %/test_install.sh %/test_mutants.sh,$(TEST_SCRIPTS))"

check-arm64: ## the same bits on aarch64, under qemu-user
	@tests/tools/check_arm64.sh

bench: ## ratios measured inside one run
	@$(MAKE) --no-print-directory -s -j$$(nproc) all $(BENCHES)
	@for b in $(BENCHES); do echo "== $${b##*/}"; $$b || exit 1; done

tables: deps-test ## the tables of docs that take minutes
	@$(MAKE) --no-print-directory -s -j$$(nproc) $(TABLES)
	@for t in $(TABLES); do $$t || exit 1; done

fuzz: ## fuzz the loaders for an hour (clang)
	@tests/tools/fuzz.sh

# ---- scenes ----
$(BUILD)/make_scenes: $(GEN_O) $(BUILD)/libassay.a
	$(CXX) $(LDFLAGS) $^ $(LDLIBS) -o $@

scenes: $(BUILD)/make_scenes ## write our own scenes again
	$(BUILD)/make_scenes scenes

# ---- certified tables: the generators see nothing of src/ and include/ ----
REF_BUILD := build/ref
REF_TOOLS := $(patsubst refdata/gen/%.c,$(REF_BUILD)/%,$(wildcard refdata/gen/gen_*.c))
REF_O     := $(patsubst refdata/gen/%.c,$(REF_BUILD)/%.o,\
               $(filter-out refdata/gen/gen_%,$(wildcard refdata/gen/*.c)))

$(REF_BUILD)/%.o: refdata/gen/%.c
	@mkdir -p $(@D)
	$(CC) -D_GNU_SOURCE -std=c11 -O2 $(WARN) -ffp-contract=off -MMD -MP -c $< -o $@

$(REF_TOOLS): $(REF_BUILD)/%: $(REF_BUILD)/%.o $(REF_O)
	$(CC) $^ -lflint-arb -lflint -lmpfr -lgmp -lm -o $@

ref: ## make the certified tables again, beside the old ones, and compare
	@$(call install_missing,$(DEPS_REF))
	@$(MAKE) --no-print-directory -s $(REF_TOOLS)
	@refdata/gen/make_tables.sh compare $(REF_TOOLS)

ref-update: ## make the certified tables again and put them in place
	@$(call install_missing,$(DEPS_REF))
	@$(MAKE) --no-print-directory -s $(REF_TOOLS)
	@refdata/gen/make_tables.sh update $(REF_TOOLS)

# ---- golden images ----
GOLDEN_ENV = BUILD=$(BUILD) ASSAY_BIN=$(BUILD)/assay
golden-check: deps-test ## render the golden images again and compare every bit
	@$(MAKE) --no-print-directory -s -j$$(nproc) all $(GOLDEN_TOOL)
	@$(GOLDEN_ENV) tests/tools/golden.sh check

golden: export REASON := $(value REASON)
golden: deps-test ## take what renders differently now: make golden REASON="why"
	@$(MAKE) --no-print-directory -s -j$$(nproc) all $(GOLDEN_TOOL)
	@$(GOLDEN_ENV) tests/tools/golden.sh renew

# ---- pictures ----
FIGURES := docs/images
figures: all ## draw the pictures of docs/methods again
	@set -e; for t in 0 30 60 80; do \
	   $(BUILD)/assay basis plot --accuracy --lobe phong:5@$$t --size 560 -o $(FIGURES)/accuracy-phong-$$t.png; done; \
	 for t in 0 30 60 75; do \
	   $(BUILD)/assay basis plot --accuracy --lobe ward:0.2,0.5@$$t --size 560 -o $(FIGURES)/accuracy-ward-$$t.png; done; \
	 for f in "1 0" "1 1" "2 0" "2 1" "2 2" "3 1"; do set -- $$f; \
	   $(BUILD)/assay basis plot --basis hsh --l $$1 --m $$2 --size 200 -o $(FIGURES)/hsh-$$1-$$2.png; done; \
	 box=scenes/cornell-box/cornell-box.gltf; \
	 draw() { name=$$1 method=$${1%%/*}; shift; $(BUILD)/assay render $$box \
	   -q --size 280x280 --layers color -m $$method --exposure 1 -o $(BUILD)/figure.exr \
	   --png $(FIGURES)/$$(echo $$name | tr / -).png "$$@"; }; \
	 draw irradiance-cache/records --debug records --a 0.3 --r-min-pixels 4 --spp 1; \
	 draw irradiance-cache/weights --debug weights --a 0.3 --r-min-pixels 4 --spp 1 --exposure 0; \
	 coarse="--a 0.4 --gradients none --r-min-pixels 8 --spp 16"; \
	 draw irradiance-cache/one-pass --passes 1 $$coarse; \
	 draw irradiance-cache/two-passes --passes 2 $$coarse; \
	 truth() { $(BUILD)/assay render $$box -q --size 280x280 --spp 1 "$$@" \
	   -o $(BUILD)/truth.exr; }; \
	 few="--secondary direct --r-min-pixels 4 --spp 1"; \
	 error="--debug error --reference $(BUILD)/truth.exr --exposure 0"; \
	 truth -m irradiance-cache --layers irradiance --secondary direct --r-min-pixels 4 --a 0.15 \
	   --gradient-limit on --theta-strata 32 --phi-strata 100; \
	 draw irradiance-cache/error $$error $$few --a 0.3; \
	 box=scenes/cornell-box-glossy/cornell-box-glossy.gltf; few="$$few --a 0.25 --glossy-accuracy 0"; \
	 truth -m radiance-cache --layers split,irradiance $$few --order 15; \
	 draw radiance-cache/records --debug records $$few; \
	 for n in 2 5 10; do draw radiance-cache/order-$$n $$error $$few --order $$n; done; \
	 box=scenes/cornell-box/cornell-box.gltf; \
	 draw splat/one-pass $$coarse; \
	 walk="--a 0.3 --r-min-pixels 4 --spp 4 --gbuffer centres"; \
	 draw splat/a-small --splat-a 0.2 --uncovered black $$walk; \
	 draw splat/a-large --splat-a 0.9 --uncovered black $$walk; \
	 mkdir -p $(BUILD)/walk; cp $${box%gltf}bin $(BUILD)/walk; \
	 sed -f $(FIGURES)/walk.sed $$box > $(BUILD)/walk/walk.gltf; box=$(BUILD)/walk/walk.gltf; \
	 draw splat/walk-# --frames 0:3 --fps 4 --max-new-records 300 --uncovered black $$walk

# ---- order in the house ----
layers: ## check that every include follows src/layers.txt
	@awk -f tests/tools/layers.awk src/layers.txt $(filter src/%,$(OURS))

format: ## format all sources
	clang-format -i $(OURS)

ONLY_FINDINGS := awk '/warnings? generated|Suppressed|Use -header-filter/ { next } \
                        { print; bad = 1 } END { exit bad }'
CPPCHECK := cppcheck --quiet --error-exitcode=1 --enable=warning,performance,portability \
            --inline-suppr --suppress=missingIncludeSystem -Iinclude -Isrc -Itests \
            -DASSAY_VERSION='"x"'

lint: layers ## clang-format, clang-tidy, cppcheck: all clean
	@$(call install_missing,$(DEPS_LINT))
	clang-format --dry-run -Werror $(OURS)
	clang-tidy --quiet $(LIB_C) $(CLI_C) $(GEN_C) $(HELP_C) $(TOOL_C) -- $(CPPFLAGS) -std=c11 \
	  2>&1 | $(ONLY_FINDINGS)
	clang-tidy --quiet $(LIB_CXX) -- $(CPPFLAGS) -std=c++17 2>&1 | $(ONLY_FINDINGS)
	$(CPPCHECK) --std=c11 $(LIB_C) $(CLI_C) $(GEN_C) $(HELP_C) $(TOOL_C) $(TEST_C) $(BENCH_C) $(TABLE_C)
	$(CPPCHECK) --std=c++17 --suppress=passedByValue $(LIB_CXX)

# ---- installing ----
install: all $(BUILD)/libassay.so ## install to $(DESTDIR)$(PREFIX)
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(LIBDIR)/pkgconfig \
	  $(DESTDIR)$(PREFIX)/include/assay $(DESTDIR)$(PREFIX)/share/man/man1
	install -m 755 $(BUILD)/assay $(DESTDIR)$(PREFIX)/bin/assay
	install -m 644 $(BUILD)/libassay.a $(DESTDIR)$(LIBDIR)/libassay.a
	install -m 755 $(BUILD)/libassay.so $(DESTDIR)$(LIBDIR)/libassay.so.$(SOVERSION)
	ln -sf libassay.so.$(SOVERSION) $(DESTDIR)$(LIBDIR)/libassay.so
	install -m 644 include/assay/*.h $(DESTDIR)$(PREFIX)/include/assay
	install -m 644 docs/assay.1 $(DESTDIR)$(PREFIX)/share/man/man1/assay.1
	printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$(LIBDIR)' 'includedir=$${prefix}/include' '' \
	  'Name: assay' 'Description: reference renderer and test oracle for light caching' \
	  'Version: $(VERSION)' 'Cflags: -I$${includedir}' 'Libs: -L$${libdir} -lassay' \
	  'Libs.private: -pthread $(LDLIBS)' > $(DESTDIR)$(LIBDIR)/pkgconfig/assay.pc

uninstall: ## remove what install put there
	rm -rf $(DESTDIR)$(PREFIX)/include/assay
	rm -f $(DESTDIR)$(PREFIX)/bin/assay $(DESTDIR)$(PREFIX)/share/man/man1/assay.1 \
	  $(DESTDIR)$(LIBDIR)/libassay.a $(DESTDIR)$(LIBDIR)/libassay.so \
	  $(DESTDIR)$(LIBDIR)/libassay.so.$(SOVERSION) $(DESTDIR)$(LIBDIR)/pkgconfig/assay.pc

clean: ## remove everything that was built
	rm -rf build

-include $(wildcard $(REF_BUILD)/*.d)
-include $(LIB_O:.o=.d) $(CLI_O:.o=.d) $(GEN_O:.o=.d) $(HELP_O:.o=.d) $(TESTS:=.d) $(BENCHES:=.d) $(TABLES:=.d) \
         $(BACKEND_O:.o=.d) $(GOLDEN_TOOL).d
.SECONDARY:
