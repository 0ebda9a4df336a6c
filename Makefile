# motes: how particles scatter light, and what media made of them look like.
# The main targets: make deps, all, check, demo, install; see README.md and CONTRIBUTING.md.
VERSION = 0.1.0
PREFIX  = /usr/local
CFLAGS  = -O2 -g
LDFLAGS =

B = build
PACKAGES = gcc libc6-dev make pkg-config libopenexr-dev libimath-dev libpng-dev zlib1g-dev libconfig-dev \
	ocl-icd-opencl-dev opencl-headers pocl-opencl-icd oclgrind mandoc openimageio-tools perl git
BENCH_PACKAGES = gnuplot-nox

OWN_CFLAGS = -std=c11 -D_GNU_SOURCE -DMOTES_VERSION='"$(VERSION)"' -DCL_TARGET_OPENCL_VERSION=120 -Ilib -ffp-contract=off -fno-math-errno -Wno-psabi \
	-fopenmp -Wall -Wextra -Wshadow -Wmissing-prototypes
OWN_LDFLAGS = -fopenmp -Wl,--as-needed
LIBS = -lOpenEXRCore -lpng -lz -lconfig -lOpenCL -lm
ASAN = -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
EXR_CFLAGS = $(shell pkg-config --cflags OpenEXR)    # asked for when used: make deps may have just installed it

TOOLS = $(patsubst tools/%.c,%,$(wildcard tools/*.c))
CHECKS = $(patsubst tests/%.c,%,$(wildcard tests/*.c))
GENERATED = materials kernels
OBJECTS = $(patsubst lib/%.c,obj/%.o,$(filter-out lib/render/lanes.c $(LOOPS:%=lib/optics/%_lanes.c),$(wildcard lib/*/*.c))) \
	$(GENERATED:%=obj/gen/%.o) $(LANE_OBJECTS) $(LOOP_OBJECTS)

# The renderer's kernels, for each processor, transport and number of wavelengths and of channels (0: any, and spectral; p: with a peak):
# LANES and the instructions.
CPUS = scalar $(if $(filter x86_64,$(shell uname -m)),v2 v3 v4)
LANES_scalar = -DLANES=1
LANES_v2 = -DLANES=4 -march=x86-64-v2
LANES_v3 = -DLANES=8 -march=x86-64-v3
LANES_v4 = -DLANES=16 -march=x86-64-v4 -mprefer-vector-width=512
LANE_OBJECTS = $(foreach cpu,$(CPUS),$(foreach t,0 1 2 3,$(foreach w,0 1 3 1p 3p,obj/render/lanes/$(cpu)_$(t)_$(w).o)))
lane_flags = -g1 -Wno-unused-parameter $(LANES_$(word 1,$(1))) -DRENDER=render_$(subst $(space),_,$(1)) -DTRANSPORT=$(word 2,$(1)) \
	$(if $(filter-out 0,$(word 3,$(1))),-DWAVES=$(subst p,,$(word 3,$(1))) -DCHANNELS=$(subst p,,$(word 3,$(1))) -DSPECTRAL=0 -DPEAK=$(if $(findstring p,$(word 3,$(1))),1,0))
space = $(subst ,, )
# Loops of lib/optics in doubles, lib/optics/*_lanes.c, for each processor. GOA's: without -fno-tree-slp-vectorize gcc contracts complex products
# whatever -ffp-contract says.
LOOPS = mie goa series
DOUBLES_scalar = -DLANES=1
DOUBLES_v2 = -DLANES=2 -march=x86-64-v2
DOUBLES_v3 = -DLANES=4 -march=x86-64-v3
DOUBLES_v4 = -DLANES=8 -march=x86-64-v4 -mprefer-vector-width=512
FLAGS_mie = -funroll-loops
FLAGS_goa = -O3 -fno-trapping-math -fcx-limited-range -fno-tree-slp-vectorize
FLAGS_series = -O3
LOOP_OBJECTS = $(foreach loop,$(LOOPS),$(CPUS:%=obj/optics/$(loop)_lanes/%.o))
MAN = $(wildcard man/*.[1-9])

all: programs
programs: $(TOOLS:%=$(B)/bin/%)
asan-programs: $(TOOLS:%=$(B)/asan/bin/%)

# One set of rules for each way to build: $(1) is the folder, $(2) further flags.
define variant
$(1)/obj/%.o: lib/%.c
	@mkdir -p $$(@D)
	$$(CC) $$(OWN_CFLAGS) $$(EXR_CFLAGS) $$(CFLAGS) $(2) -MMD -MP -c -o $$@ $$<
$(addprefix $(1)/,$(LANE_OBJECTS)): $(1)/obj/render/lanes/%.o: lib/render/lanes.c
	@mkdir -p $$(@D)
	$$(CC) $$(OWN_CFLAGS) $$(CFLAGS) $(if $(2),$(2) -O1,-O3) $$(call lane_flags,$$(subst _, ,$$*)) -MMD -MP -c -o $$@ $$<
$(foreach loop,$(LOOPS),$(CPUS:%=$(1)/obj/optics/$(loop)_lanes/%.o): $(1)/obj/optics/$(loop)_lanes/%.o: lib/optics/$(loop)_lanes.c
	@mkdir -p $$(@D)
	$$(CC) $$(OWN_CFLAGS) $$(CFLAGS) $$(FLAGS_$(loop)) $(if $(2),$(2) -O1) $$(DOUBLES_$$*) -DBUILD=$(loop)_lanes_$$* -MMD -MP -c -o $$@ $$<
)
$(1)/obj/gen/%.o: $(B)/gen/%.c
	@mkdir -p $$(@D)
	$$(CC) $$(OWN_CFLAGS) $$(CFLAGS) $(2) -MMD -MP -c -o $$@ $$<
$(1)/libmotes.a: $(addprefix $(1)/,$(OBJECTS))
	rm -f $$@
	$$(AR) rcs $$@ $$^
$(1)/bin/%: tools/%.c $(1)/libmotes.a
	@mkdir -p $$(@D)
	$$(CC) $$(OWN_CFLAGS) $$(EXR_CFLAGS) $$(CFLAGS) $(2) -MMD -MP -MF $$@.d $$(OWN_LDFLAGS) $$(LDFLAGS) -o $$@ $$< $(1)/libmotes.a $$(LIBS)
$(1)/tests/%: tests/%.c $(1)/libmotes.a
	@mkdir -p $$(@D)
	$$(CC) $$(OWN_CFLAGS) $$(CFLAGS) $(2) -MMD -MP -MF $$@.d $$(OWN_LDFLAGS) $$(LDFLAGS) -o $$@ $$< $(1)/libmotes.a $$(LIBS)
endef
$(eval $(call variant,$(B),))
$(eval $(call variant,$(B)/asan,$(ASAN)))

# Tables of data/materials and the kernels' text become C, so that a program needs no files beside it.
$(B)/gen/materials.c: lib/optics/materials.awk $(wildcard data/materials/*.tsv)
	@mkdir -p $(@D)
	awk -f $^ >$@.new && mv $@.new $@
$(B)/gen/kernels.c: lib/render/embed.awk lib/render/kern/sources $(wildcard lib/render/kern/*.h lib/render/kern/*.cl)
	@mkdir -p $(@D)
	awk -f $< $$(sed 's,^,lib/render/kern/,' lib/render/kern/sources) >$@.new && mv $@.new $@

# Everything that building, the demo, the tests and the benchmarks need, from Debian's own packages.
deps:
	@missing=$$(dpkg-query -W -f '$${db:Status-Status} $${Package}\n' $(PACKAGES) $(BENCH_PACKAGES) 2>&1 | grep -v '^installed '); \
	[ -n "$$missing" ] || exit 0; \
	if ! command -v apt-get >/dev/null; then echo 'make deps: no apt-get here; install by hand: $(PACKAGES) $(BENCH_PACKAGES)' >&2; exit 1; fi; \
	if [ "$$(id -u)" = 0 ]; then as=; elif command -v sudo >/dev/null; then as='sudo'; \
	else echo 'make deps: needs root or sudo; install by hand: $(PACKAGES) $(BENCH_PACKAGES)' >&2; exit 1; fi; \
	apt='apt-get -q -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3'; \
	$$as $$apt update && $$as env DEBIAN_FRONTEND=noninteractive $$apt install -y --no-install-recommends $(PACKAGES) $(BENCH_PACKAGES)

check: programs $(CHECKS:%=$(B)/tests/%)
	MOTES_BUILD=$(B) sh tests/run
asan: asan-programs $(CHECKS:%=$(B)/asan/tests/%)
	MOTES_BUILD=$(B)/asan sh tests/run

demo: programs
	@mkdir -p $(B)/demo
	PATH="$(CURDIR)/$(B)/bin:$$PATH" $(MAKE) -C data/scenes/mist OUT="$(CURDIR)/$(B)/demo"

# Charts of error against time, in $(B)/bench: of all, and, with Mitsuba 3 from PyPI where it can be had, of the renderer's speed.
RENDER_BENCHES = render lanes particles
MIE_BENCHES = mie
XSECT_BENCHES = xsect
CHARTS = $(patsubst tests/bench/%.sh,%,$(wildcard tests/bench/chart-*.sh))
BENCHES = $(filter-out $(RENDER_BENCHES) $(MIE_BENCHES) $(XSECT_BENCHES) $(CHARTS),$(patsubst tests/bench/%.sh,%,$(wildcard tests/bench/*.sh)))
bench: programs $(CHECKS:%=$(B)/tests/%)
	PATH="$(CURDIR)/$(B)/bin:$$PATH" MOTES_TESTS="$(CURDIR)/$(B)/tests" sh tests/bench/run $(B)/bench $(BENCHES)
bench-render: programs
	sh tests/bench/mitsuba-venv $(B)/mitsuba-venv
	PATH="$(CURDIR)/$(B)/bin:$$PATH" MOTES_MITSUBA="$(CURDIR)/$(B)/mitsuba-venv" sh tests/bench/run $(B)/bench $(RENDER_BENCHES)
# Lorenz-Mie theory beside the codes that PyPI has, and beside a textbook's loop.
bench-mie: programs
	sh tests/bench/mie-venv $(B)/mie-venv
	PATH="$(CURDIR)/$(B)/bin:$$PATH" CC="$(CC)" MOTES_ARCHIVE="$(CURDIR)/$(B)/libmotes.a" MOTES_PEERS="$(CURDIR)/$(B)/mie-venv" \
	sh tests/bench/run $(B)/bench $(MIE_BENCHES)
# Cross sections by the cheapest method within a tolerance.
bench-xsect: programs $(B)/tests/ladder
	PATH="$(CURDIR)/$(B)/bin:$$PATH" MOTES_TESTS="$(CURDIR)/$(B)/tests" sh tests/bench/run $(B)/bench $(XSECT_BENCHES)
# What each method is good for: error against time, the cheapest method, and where each fails. Beside each chart is a text of how it is made.
charts: programs
	PATH="$(CURDIR)/$(B)/bin:$$PATH" sh tests/bench/run $(B)/charts $(CHARTS)

install: programs
	install -d $(DESTDIR)$(PREFIX)/bin
	install -m 755 $(TOOLS:%=$(B)/bin/%) $(DESTDIR)$(PREFIX)/bin
	for m in $(MAN); do s=$${m##*.}; install -d $(DESTDIR)$(PREFIX)/share/man/man$$s && \
		install -m 644 $$m $(DESTDIR)$(PREFIX)/share/man/man$$s || exit 1; done

clean:
	rm -rf $(B)

.PHONY: all programs asan-programs deps check asan demo bench charts bench-render bench-mie bench-xsect install clean
.SECONDARY:
ifneq ($(filter deps,$(MAKECMDGOALS)),)
.NOTPARALLEL:
endif
-include $(shell find $(B) -name '*.d' 2>/dev/null)
