# assay - `make help` lists the targets.

VERSION := 0.1.0
PREFIX  ?= /usr/local
DESTDIR ?=
BUILD   ?= build/release
CC      ?= cc
CXX     ?= c++
AR      ?= ar
OPT     ?= -O3 -g
SAN     ?=
PKG_CONFIG ?= pkg-config

# What `make deps` installs (Debian 12).
DEPS_BUILD := gcc g++ make pkg-config libembree-dev libopenexr-dev libtinygltf-dev libsleef-dev \
              librandom123-dev libpng-dev libjpeg-dev libcjson-dev libmd-dev libgomp1
DEPS_TEST  := libcmocka-dev clang libomp-dev

# Same bits everywhere: no contraction, no fast math, no -march (docs/determinism.md).
CPPFLAGS += -D_GNU_SOURCE -DASSAY_VERSION='"$(VERSION)"' -Iinclude -Isrc -isystem /usr/include/OpenEXR \
            -isystem /usr/include/Imath
WARN     := -Wall -Wextra -Wshadow -Wundef -Wvla -Wpointer-arith -Wcast-align
CFLAGS   += -std=c11 $(OPT) $(WARN) -Wstrict-prototypes -Wmissing-prototypes -ffp-contract=off \
            -fvisibility=hidden -fPIC -fopenmp $(SAN)
CXXFLAGS += -std=c++17 $(OPT) $(WARN) -ffp-contract=off -fvisibility=hidden -fPIC $(SAN)
LDFLAGS  += -fopenmp $(SAN)
LDLIBS   += -lembree3 -lOpenEXRCore -ltinygltf -lsleef -lpng -ljpeg -lcjson -lmd -lm -lstdc++

LIB_C   := $(filter-out src/cli/%,$(wildcard src/*/*.c src/*/*/*.c))
LIB_CXX := $(wildcard src/*/*.cpp)
CLI_C   := $(wildcard src/cli/*.c)
LIB_O   := $(LIB_C:%.c=$(BUILD)/%.o) $(LIB_CXX:%.cpp=$(BUILD)/%.o)
CLI_O   := $(CLI_C:%.c=$(BUILD)/%.o)
TESTS   := $(patsubst %.c,$(BUILD)/%,$(wildcard tests/*/test_*.c))
HELP_C  := $(wildcard tests/support/*.c)
HELP_O  := $(HELP_C:%.c=$(BUILD)/%.o)

.PHONY: all help deps demo test clean
all: $(BUILD)/assay ## build the command and the library

help: ## list the targets
	@sed -n 's/^\([a-z0-9-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 18

$(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c $< -o $@

$(BUILD)/%.o: %.cpp
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS) $(CXXFLAGS) -MMD -MP -c $< -o $@

$(BUILD)/libassay.a: $(LIB_O)
	@rm -f $@
	$(AR) rcs $@ $^

$(BUILD)/assay: $(CLI_O) $(BUILD)/libassay.a
	$(CC) $(LDFLAGS) $^ $(LDLIBS) -o $@

# ---- tests ----
$(BUILD)/tests/%: $(BUILD)/tests/%.o $(HELP_O) $(BUILD)/libassay.a
	$(CC) $(LDFLAGS) $^ -lcmocka $(LDLIBS) -o $@

clean: ## remove everything that was built
	rm -rf build

-include $(LIB_O:.o=.d) $(CLI_O:.o=.d) $(TESTS:=.d) $(HELP_O:.o=.d)
.SECONDARY:
