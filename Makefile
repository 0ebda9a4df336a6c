# motes: how particles scatter light, and what media made of them look like.
# The main targets: make deps, all, check, demo, install; see README.md and CONTRIBUTING.md.
VERSION = 0.1.0
PREFIX  = /usr/local
CFLAGS  = -O2 -g
LDFLAGS =

B = build

# Debian's packages, by what needs them.
PACKAGES_all   = gcc libc6-dev make pkg-config libopenexr-dev libimath-dev libpng-dev zlib1g-dev libconfig-dev \
	ocl-icd-opencl-dev opencl-headers
PACKAGES_check = pocl-opencl-icd oclgrind mandoc openimageio-tools perl git gnuplot-nox
PACKAGES_check-quick = $(PACKAGES_check)
PACKAGES_bench = pocl-opencl-icd perl gnuplot-nox
PACKAGES_charts = $(PACKAGES_bench)
PACKAGES_asan = $(PACKAGES_check)

OWN_CFLAGS = -std=c11 -D_GNU_SOURCE -DMOTES_VERSION='"$(VERSION)"' -DCL_TARGET_OPENCL_VERSION=120 -Ilib -I$(B) -ffp-contract=off -fno-math-errno -Wno-psabi \
	-fopenmp -Wall -Wextra -Wshadow -Wmissing-prototypes
OWN_LDFLAGS = -fopenmp -Wl,--as-needed
LIBS = -lOpenEXRCore -lpng -lz -lconfig -lOpenCL -lm
ASAN = -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
EXR_CFLAGS = $(shell pkg-config --cflags OpenEXR)    # asked for when used: make deps may have just installed it

KINDS = unit cli physics support     # of tests, and what they share
TOOLS = $(patsubst tools/%.c,%,$(wildcard tools/*.c))
CHECKS = $(patsubst tests/%.c,%,$(wildcard $(KINDS:%=tests/%/*.c)))
GENERATED = materials kernels
OBJECTS = $(patsubst lib/%.c,obj/%.o,$(filter-out lib/render/kernels_c.c $(LOOPS),$(wildcard lib/*/*.c lib/*/*/*.c))) \
	$(GENERATED:%=obj/gen/%.o) $(KERNEL_OBJECTS) $(LOOP_OBJECTS)

# The processors that loops are built for: the one at hand and plain C, or all of its family (make CPUS=all), which then goes for later
# makes here, too (until make CPUS=native).
CPUS = $(or $(shell sed -n 's,^/\* \(.*\) \*/$$,\1,p' $(B)/gen/cpu_builds.h 2>/dev/null),native)
ALL_CPUS = scalar $(if $(filter x86_64,$(shell uname -m)),v2 v3 v4)
NATIVE = $(shell $(CC) -march=native -dM -E -x c /dev/null 2>/dev/null | awk '{ has[$$2] = 1 } END { \
	print has["__AVX512BW__"] && has["__AVX512DQ__"] && has["__AVX512VL__"] && has["__AVX512CD__"] ? "v4" : \
	has["__AVX2__"] && has["__BMI2__"] && has["__FMA__"] ? "v3" : has["__SSE4_2__"] && has["__POPCNT__"] ? "v2" : "" }')
BUILT := $(filter $(if $(filter all,$(CPUS)),$(ALL_CPUS),scalar $(subst native,$(NATIVE),$(CPUS))),$(ALL_CPUS))

# The renderer's kernels, for each processor (LANES and the instructions) and number of wavelengths and channels (any: spectral ones,
# and several media, too), and once more for continuous media without a forward peak, which know no steps to wait for.
FLOATS_scalar = -DLANES=1
FLOATS_v2 = -DLANES=4 -march=x86-64-v2
FLOATS_v3 = -DLANES=8 -march=x86-64-v3
FLOATS_v4 = -DLANES=16 -march=x86-64-v4 -mprefer-vector-width=512
CONSTANTS_any =
CONSTANTS_1 = -DVOLUMES=1 -DWAVES=1 -DCHANNELS=1 -DSPECTRAL=0
CONSTANTS_3 = -DVOLUMES=1 -DWAVES=3 -DCHANNELS=3 -DSPECTRAL=0
CONSTANTS_smooth1 = $(CONSTANTS_1) -DTRANSPORT=TRANSPORT_CONTINUOUS -DPEAK=0
CONSTANTS_smooth3 = $(CONSTANTS_3) -DTRANSPORT=TRANSPORT_CONTINUOUS -DPEAK=0
KERNEL_OBJECTS = $(foreach cpu,$(BUILT),$(foreach known,any 1 3 smooth1 smooth3,obj/render/kernels_c/$(known)_$(cpu).o))

# Loops of lib/optics in doubles, *_lanes.c, for each processor. GOA's: without -fno-tree-slp-vectorize gcc contracts complex products
# whatever -ffp-contract says.
LOOPS = $(wildcard lib/optics/*/*_lanes.c)
DOUBLES_scalar = -DLANES=1
DOUBLES_v2 = -DLANES=2 -march=x86-64-v2
DOUBLES_v3 = -DLANES=4 -march=x86-64-v3
DOUBLES_v4 = -DLANES=8 -march=x86-64-v4 -mprefer-vector-width=512
FLAGS_mie_lanes = -funroll-loops
FLAGS_goa_lanes = -O3 -fno-trapping-math -fcx-limited-range -fno-tree-slp-vectorize
FLAGS_goa_plus_lanes = $(FLAGS_goa_lanes)
FLAGS_legendre_series_lanes = -O3
LOOP_OBJECTS = $(foreach loop,$(LOOPS:lib/%.c=%),$(BUILT:%=obj/$(loop)/%.o))
MAN = $(wildcard man/*.[1-9])

# As many jobs as there are cores, unless told otherwise; a line a file, or with V=1 its command.
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(shell nproc 2>/dev/null || echo 2)
endif
say = $(if $(V),,@echo '  $(1)';)
space = $(subst ,, )
comma = ,

all: programs
programs: $(TOOLS:%=$(B)/bin/%)
asan-programs: $(TOOLS:%=$(B)/asan/bin/%)

# One set of rules for each way to build: $(1) is the folder, $(2) further flags.
define variant
$(1)/obj/%.o: lib/%.c | $(B)/gen/cpu_builds.h
	@mkdir -p $$(@D)
	$$(call say,CC $$<)$$(CC) $$(OWN_CFLAGS) $$(EXR_CFLAGS) $$(CFLAGS) $(2) -MMD -MP -c -o $$@ $$<
$(addprefix $(1)/,$(KERNEL_OBJECTS)): $(1)/obj/render/kernels_c/%.o: lib/render/kernels_c.c | $(B)/gen/cpu_builds.h
	@mkdir -p $$(@D)
	$$(call say,CC $$@)$$(CC) $$(OWN_CFLAGS) $$(CFLAGS) $(if $(2),$(2) -O1,-O3) -g1 -Wno-unused-parameter $$(FLOATS_$$(word 2,$$(subst _, ,$$*))) \
		$$(CONSTANTS_$$(word 1,$$(subst _, ,$$*))) -DRENDER=render_$$* -MMD -MP -c -o $$@ $$<
$(foreach loop,$(LOOPS),$(BUILT:%=$(1)/$(loop:lib/%.c=obj/%)/%.o): $(1)/$(loop:lib/%.c=obj/%)/%.o: $(loop) | $(B)/gen/cpu_builds.h
	@mkdir -p $$(@D)
	$$(call say,CC $$@)$$(CC) $$(OWN_CFLAGS) $$(CFLAGS) $$(FLAGS_$(basename $(notdir $(loop)))) $(if $(2),$(2) -O1) $$(DOUBLES_$$*) \
		-DBUILD=$(basename $(notdir $(loop)))_$$* -MMD -MP -c -o $$@ $$<
)
$(1)/obj/gen/%.o: $(B)/gen/%.c | $(B)/gen/cpu_builds.h
	@mkdir -p $$(@D)
	$$(call say,CC $$<)$$(CC) $$(OWN_CFLAGS) $$(CFLAGS) $(2) -MMD -MP -c -o $$@ $$<
$(1)/libmotes.a: $(addprefix $(1)/,$(OBJECTS))
	@rm -f $$@
	$$(call say,AR $$@)$$(AR) rcs $$@ $$^
$(1)/bin/%: tools/%.c $(1)/libmotes.a
	@mkdir -p $$(@D)
	$$(call say,LD $$@)$$(CC) $$(OWN_CFLAGS) $$(EXR_CFLAGS) $$(CFLAGS) $(2) -MMD -MP -MF $$@.d $$(OWN_LDFLAGS) $$(LDFLAGS) -o $$@ $$< $(1)/libmotes.a $$(LIBS)
$(1)/tests/%: tests/%.c $(1)/libmotes.a
	@mkdir -p $$(@D)
	$$(call say,LD $$@)$$(CC) $$(OWN_CFLAGS) -Itests $$(CFLAGS) $(2) -MMD -MP -MF $$@.d $$(OWN_LDFLAGS) $$(LDFLAGS) -o $$@ $$< $(1)/libmotes.a $$(LIBS)
endef
$(eval $(call variant,$(B),))
$(eval $(call variant,$(B)/asan,$(ASAN)))

# Tables of data/materials and the kernels' text become C, so that a program needs no files beside it.
$(B)/gen/materials.c: lib/optics/index/materials.awk $(wildcard data/materials/*.tsv)
	@mkdir -p $(@D)
	@awk -f $^ >$@.new && mv $@.new $@
$(B)/gen/kernels.c: lib/render/kernels_text.awk lib/render/kern/sources $(wildcard lib/render/kern/*.h lib/render/kern/*.cl)
	@mkdir -p $(@D)
	@awk -f $< $$(sed 's,^,lib/render/kern/,' lib/render/kern/sources) >$@.new && mv $@.new $@

LEVEL_scalar = SCALAR
LEVEL_v2 = V2
LEVEL_v3 = V3
LEVEL_v4 = V4
# Which builds there are, for lib/base/cpu.h; written anew where CPUS asks for others.
define CPU_BUILDS
/* $(BUILT) */
#define CPU_BUILT (0 $(foreach cpu,$(BUILT),| 1 << CPU_$(LEVEL_$(cpu))))
#define CPU_BUILDS(name) { $(foreach cpu,$(BUILT),[CPU_$(LEVEL_$(cpu))] = name##_$(cpu),) }
#define CPU_DECLARE(type, name) extern type $(subst $(space),$(comma) ,$(BUILT:%=name##_%))
endef
export CPU_BUILDS
$(B)/gen/cpu_builds.h: always
	@mkdir -p $(@D)
	@printf '%s\n' "$$CPU_BUILDS" | cmp -s - $@ || printf '%s\n' "$$CPU_BUILDS" >$@

# ---- packages

# make deps GOAL..: first what the goals need of Debian's packages, then the goals by a make of its own, and how long each took.
GOALS = $(or $(filter-out deps,$(MAKECMDGOALS)),all)
PACKAGES = $(sort $(foreach goal,all $(GOALS),$(PACKAGES_$(patsubst bench-%,bench,$(goal)))))
ifneq ($(filter deps,$(MAKECMDGOALS)),)
.NOTPARALLEL:
deps:
	@begun=$$(date +%s); \
	missing=$$(dpkg-query -W -f '$${db:Status-Status} $${Package}\n' $(PACKAGES) 2>&1 | sed -n '/^installed /d; s/^[a-z-]* \([^ ]*\)$$/\1/p; s/.*no packages found matching //p' | paste -sd' ' -); \
	if [ -z "$$missing" ]; then echo 'make deps: all packages are here'; exit 0; fi; \
	if ! command -v apt-get >/dev/null; then echo "make deps: no apt-get here; install by hand: $$missing" >&2; exit 1; fi; \
	if [ "$$(id -u)" = 0 ]; then as=; elif command -v sudo >/dev/null; then as='sudo'; \
	else echo "make deps: needs root or sudo; install by hand: $$missing" >&2; exit 1; fi; \
	echo "make deps: installing for $(GOALS): $$missing"; \
	apt='apt-get -q -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3'; \
	$$as $$apt update && $$as env DEBIAN_FRONTEND=noninteractive $$apt install -y --no-install-recommends $$missing && \
	echo "make deps: packages took $$(($$(date +%s) - begun)) s"
$(filter-out deps,$(MAKECMDGOALS)): deps
	@begun=$$(date +%s); $(MAKE) --no-print-directory $(if $(filter check,$@),CPUS=all check-programs,programs) && \
	echo "make deps: programs took $$(($$(date +%s) - begun)) s" && $(MAKE) --no-print-directory $@
else
# The tests compare the builds of all processors; then the widest is hidden, so that the next one has to stand alone.
check: ; @$(MAKE) --no-print-directory CPUS=all check-programs && MOTES_BUILD=$(B) sh tests/run && MOTES_BUILD=$(B) sh tests/run --capped
# For those at work: under a minute on two cores, for the processor at hand.
check-quick: check-programs ; MOTES_BUILD=$(B) sh tests/run --quick
check-programs: programs $(CHECKS:%=$(B)/tests/%)
asan: ; @$(MAKE) --no-print-directory CPUS=all programs asan-check-programs && MOTES_BUILD=$(B)/asan sh tests/run
asan-check-programs: asan-programs $(CHECKS:%=$(B)/asan/tests/%)

demo: programs
	@mkdir -p $(B)/demo
	@begun=$$(date +%s); PATH="$(CURDIR)/$(B)/bin:$$PATH" $(MAKE) --no-print-directory -C data/scenes/spray OUT="$(CURDIR)/$(B)/demo" && \
	echo "the picture took $$(($$(date +%s) - begun)) s: $(B)/demo/spray.png"

# Charts of error against time, in $(B)/bench: of all, and, with Mitsuba 3 from PyPI where it can be had, of the renderer's speed.
RENDER_BENCHES = render lanes particles
MIE_BENCHES = mie
XSECT_BENCHES = xsect
CHARTS = $(patsubst tests/bench/%.sh,%,$(wildcard tests/bench/chart-*.sh))
BENCHES = $(filter-out $(RENDER_BENCHES) $(MIE_BENCHES) $(XSECT_BENCHES) $(CHARTS),$(patsubst tests/bench/%.sh,%,$(wildcard tests/bench/*.sh)))
bench: programs $(CHECKS:%=$(B)/tests/%) $(B)/tests/bench/goa
	PATH="$(CURDIR)/$(B)/bin:$$PATH" MOTES_TESTS="$(CURDIR)/$(B)/tests" sh tests/bench/run $(B)/bench $(BENCHES)
bench-render: programs $(B)/tests/support/block_means
	sh tests/bench/mitsuba-venv $(B)/mitsuba-venv
	PATH="$(CURDIR)/$(B)/bin:$(CURDIR)/$(B)/tests/support:$$PATH" MOTES_MITSUBA="$(CURDIR)/$(B)/mitsuba-venv" sh tests/bench/run $(B)/bench $(RENDER_BENCHES)
# Lorenz-Mie theory beside the codes that PyPI has, and beside a textbook's loop.
bench-mie: programs
	sh tests/bench/mie-venv $(B)/mie-venv
	PATH="$(CURDIR)/$(B)/bin:$$PATH" CC="$(CC)" MOTES_ARCHIVE="$(CURDIR)/$(B)/libmotes.a" MOTES_PEERS="$(CURDIR)/$(B)/mie-venv" \
	sh tests/bench/run $(B)/bench $(MIE_BENCHES)
# Cross sections by the cheapest method within a tolerance.
bench-xsect: programs $(B)/tests/physics/method_selection
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

endif

.PHONY: all programs asan-programs check-programs asan-check-programs deps check check-quick asan demo bench charts bench-render bench-mie bench-xsect install clean always
.SECONDARY:
-include $(shell find $(B) -name '*.d' 2>/dev/null)
