# petsam: build, test, install. `make help` lists the targets.
#
# Needs PETSc (3.18 or later), FFTW with MPI, parallel HDF5, MPI; CMocka for the tests.
# PETSC_DIR and PETSC_ARCH choose a PETSc other than the system's. OPT sets the optimisation flags: OPT="-O3 -g" is for a
# debugger, as -g takes a sixth of the build's time.

PKG_CONFIG ?= pkg-config
OPT        ?= -O3
WERROR     ?=
READELF    ?= readelf
# within the shared library, calls go straight to its own functions
BIND       ?= -Wl,-Bsymbolic-functions
prefix     ?= /usr/local
ifeq ($(origin PREFIX),command line)
  $(error PREFIX=$(PREFIX) has no effect: write prefix=$(PREFIX))
endif
PYTHON     ?= python3
B          := build
# one name of a folder in this tree, so that the rules of dependencies name the same objects
override B := $(patsubst $(CURDIR)/%,%,$(B))
# `make V=1` shows the commands
Q          := $(if $(V),,@)
say        := $(if $(V),@true,@echo)

# set in the command itself: before GNU make 4.4, $(shell) does not see exported variables
ifneq ($(PETSC_DIR),)
  PC := PKG_CONFIG_PATH="$(PETSC_DIR)/$(PETSC_ARCH)/lib/pkgconfig:$(PETSC_DIR)/lib/pkgconfig:$(PKG_CONFIG_PATH)" $(PKG_CONFIG)
  RPATH := -Wl,-rpath,$(shell $(PC) --variable=libdir petsc)
else
  PC := $(PKG_CONFIG)
endif
HDF5_PC := $(shell for p in hdf5-openmpi hdf5-mpich hdf5; do $(PC) --exists $$p && echo $$p && break; done)
PACKAGES := petsc fftw3 $(HDF5_PC)

# `:=`, so that pkg-config is called once and not for every file
PC_CFLAGS := $(shell $(PC) --cflags $(PACKAGES))
PC_LIBS   := $(shell $(PC) --libs-only-L --libs-only-other $(PACKAGES)) $(RPATH) -lfftw3_mpi -lfftw3f_mpi -lfftw3f $(shell $(PC) --libs-only-l $(PACKAGES)) -lhdf5_hl $(if $(HDF5_PC),,-lhdf5) $(if $(filter Linux,$(shell uname -s)),-lrt) -lm
ifeq ($(origin CC),default)
  CC := mpicc
endif

# clang also reports which loops it does not vectorise: with reductions by maximum it cannot
CLANG    := $(findstring clang,$(shell $(CC) --version 2>/dev/null))
WARNINGS := -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Wpointer-arith $(if $(CLANG),-Wno-pass-failed) $(if $(WERROR),-Werror)
ALL_CFLAGS = -std=c11 -D_GNU_SOURCE -fopenmp-simd -fno-math-errno -fno-trapping-math $(OPT) -fPIC -Iinclude -I$(B) $(PC_CFLAGS) $(WARNINGS) -MMD -MP $(CFLAGS)

LIB_SRC := $(sort $(shell find src -name "*.c" ! -path "src/front/app/*" ! -path "src/front/examine/*"))
PROGRAMS := petsam petsam-stress
# the scripts: petsam-plot, and links to it, one for the command of each application
LINKS := $(patsubst scripts/petsam/apps/%/command.py,petsam-%,$(sort $(wildcard scripts/petsam/apps/*/command.py)))
TOOLS := petsam-plot $(LINKS)
APP_SRC := $(filter-out $(PROGRAMS:%=src/front/app/%.c),$(sort $(wildcard src/front/app/*.c src/front/app/*/*.c)))
LIB_OBJ := $(LIB_SRC:%.c=$(B)/obj/%.o)
APP_OBJ := $(APP_SRC:%.c=$(B)/obj/%.o)
BENCHES := $(patsubst tests/bench/%.c,$(B)/bench/%,$(wildcard tests/bench/*.c))
UNIT    := $(patsubst tests/unit/%.c,$(B)/tests/%,$(wildcard tests/unit/test_*.c))
# types from outside of the library, for the unit tests
METHODS := $(patsubst %.c,$(B)/obj/%.o,$(wildcard tests/unit/methods/*.c examples/embed/plugin/*.c))

# what the library runs on a file before it opens it
EXAMINE := $(B)/lib/petsam/petsam-examine

VERSION := $(shell sed -nE 's/^\#define SAM_VERSION_(MAJOR|MINOR|SUBMINOR) +//p' include/petsam/base.h | paste -sd.)
# what programs are linked with: it changes with major and minor, as the interface may
SONAME  := libpetsam.so.$(basename $(VERSION))
HEADERS := include/petsam.h $(sort $(wildcard include/petsam/*.h include/petsam/private/*.h))

.PHONY: all help pages units bench bench-programs reference peers venv test check-slow check-sanitize check-valgrind check-clang check-petsc check-mutants check-fuzz check-readmes format check-format lint install wheel site clean creep-table
.DELETE_ON_ERROR:
.SECONDARY:

all: $(PROGRAMS:%=$(B)/bin/%) $(B)/lib/libpetsam.a $(B)/lib/libpetsam.so $(EXAMINE) $(LINKS:%=scripts/%) ## build the program and the libraries
	@mkdir -p $(B)/run # where the commands of the pages write

$(LINKS:%=scripts/%):
	$(Q)ln -s petsam-plot $@

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 18

# the list of headers names the object by $(B), which may be given relative or absolute for the same folder
$(B)/obj/%.o: %.c
	@mkdir -p $(@D)
	$(say) CC $<
	$(Q)$(CC) $(ALL_CFLAGS) -MT '$$(B)/obj/$*.o' -c $< -o $@

# the text of -help
$(PROGRAMS:%=$(B)/obj/src/front/app/%.o): $(B)/obj/src/front/app/%.o: $(B)/help/%.h
$(B)/help/%.h: src/front/app/%.help scripts/maintain/help.awk include/petsam/base.h
	@mkdir -p $(@D)
	$(Q)awk -v version=$(VERSION) -f scripts/maintain/help.awk $< > $@

$(B)/lib/libpetsam.a: $(LIB_OBJ)
	@mkdir -p $(@D)
	$(say) AR $@
	$(Q)rm -f $@ && $(AR) rcs $@ $^

# the shared library exports what the headers declare by PETSC_EXTERN and not by PETSC_INTERN: under the version of the
# interface what public headers declare, and what the programs and new types use of private ones without a promise
$(B)/lib/exports.map: $(B)/lib/libpetsam.a $(HEADERS)
	$(Q)$(READELF) -sW $< | awk '($$4 == "FUNC" || $$4 == "OBJECT") && $$5 == "GLOBAL" && $$6 == "DEFAULT" && $$7 != "UND" && $$8 ~ /^(Sam|petsam_)[A-Za-z0-9_]+$$/ { print $$8 }' | sort -u > $@.all
	$(Q)grep -hE 'PETSC_EXTERN|petsam_' include/petsam/*.h | grep -oE '(Sam|petsam_)[A-Za-z0-9_]+' | sort -u > $@.public
	$(Q){ echo 'PETSAM_$(firstword $(subst ., ,$(VERSION))) { global:'; comm -12 $@.all $@.public | sed 's/$$/;/'; echo 'local: *; };'; echo 'PETSAM_PRIVATE { global:'; comm -23 $@.all $@.public | sed 's/$$/;/'; echo '};'; } > $@

$(B)/lib/libpetsam.so: $(LIB_OBJ) $(B)/lib/exports.map
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) -shared $(BIND) -Wl,-soname,$(SONAME) -Wl,--version-script=$(B)/lib/exports.map $(LDFLAGS) -o $@.$(VERSION) $(LIB_OBJ) $(PC_LIBS)
	$(Q)cd $(@D) && ln -sf $(@F).$(VERSION) $(SONAME) && ln -sf $(SONAME) $(@F)

# with the shared library beside them, whose lists of types plugins add to
$(PROGRAMS:%=$(B)/bin/%): $(B)/bin/%: $(B)/obj/src/front/app/%.o $(APP_OBJ) $(B)/lib/libpetsam.so
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ '-Wl,-rpath,$$ORIGIN/../lib' $(PC_LIBS)

$(EXAMINE): src/front/examine/petsam-examine.c
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) -std=c11 -D_GNU_SOURCE -O2 $(PC_CFLAGS) $(WARNINGS) $(LDFLAGS) -o $@ $< -Wl,--as-needed $(PC_LIBS)

$(B)/bench/%: $(B)/obj/tests/bench/%.o $(B)/lib/libpetsam.a
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(PC_LIBS)

$(B)/tests/%: $(B)/obj/tests/unit/%.o $(METHODS) $(APP_OBJ) $(B)/lib/libpetsam.a
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(PC_LIBS) -lcmocka

units: $(UNIT) $(EXAMINE) ## build the unit tests

bench-programs: $(BENCHES) ## build the benchmark's programs

bench: all bench-programs venv peers ## run the benchmark, or go on with an unfinished one; the report is in build/bench/report: ARGS=--quick for a short one, ARGS=--anew to start over, CONTACT=folder beside a built CONTACT
	$(PYTHON) tests/bench/benchmark.py --build $(B) --out $(B)/bench/report $(ARGS)
	$(B)/venv/bin/python tests/bench/edges.py --build $(B)
	$(PYTHON) tests/bench/rolling.py --build $(B)
	[ ! -e $(B)/peers/done ] || $(PYTHON) tests/bench/paired.py --build $(B)
	[ ! -e $(B)/peers/done ] || $(PYTHON) tests/bench/plastic.py --build $(B)
	$(if $(CONTACT),$(B)/venv/bin/python tests/bench/contact.py --build $(B) --contact '$(CONTACT)')

reference: all $(B)/venv/tests-done ## petsam's answers to the problems of examples/reference, and their digits: ARGS="CASE ..." for some; PEERS="tamaas aspher contact calculix" for those of other programs
	$(B)/venv/bin/python -W ignore examples/reference/reference.py answers $(ARGS) -o $(B)/run/answers.json
	$(B)/venv/bin/python examples/reference/check.py $(B)/run/answers.json
	$(foreach peer,$(PEERS),$(B)/$(if $(filter tamaas aspher,$(peer)),peers,venv)/bin/python examples/reference/peers.py $(peer) $(ARGS) -o $(B)/run/$(peer).json && $(B)/venv/bin/python examples/reference/check.py $(B)/run/$(peer).json;)

creep-table: all $(B)/venv/done ## the table of creep forces for include/petsam/creep.h, about 10 minutes of CPU: ARGS="--poisson 0.25 --jobs 4"
	$(B)/venv/bin/python scripts/maintain/make_creep_table.py make -o $(B)/creep-forces.bin $(ARGS)

# the programs that the benchmark compares with, built for this processor; the benchmark also runs without them
peers: $(B)/peers/done ## install the programs that the benchmark compares with
$(B)/peers/done: tests/bench/requirements.txt
	@mkdir -p $(B)
	$(PYTHON) -m venv $(B)/peers
	@while read -r package; do \
	  CMAKE_ARGS="-DASPHER_USE_FFTW=ON -DASPHER_NATIVE=ON" $(B)/peers/bin/python -m pip install -q --disable-pip-version-check --no-cache-dir $$package || \
	    { echo "peers: no $$package: aspher needs g++ and libeigen3-dev" >&2; failed=1; }; \
	done < $<; [ -n "$$failed" ] || touch $@

# the scripts' Python environment, from PyPI, made again when its list changes; it finds the package in scripts/. Python
# compiles a module when it is first used: to compile all takes half of pip's time
venv: $(B)/venv/done ## make the Python environment of the scripts
$(B)/venv/done: scripts/requirements.txt
	@mkdir -p $(B)
	$(PYTHON) -m venv $(B)/venv
	$(B)/venv/bin/python -m pip install -q --disable-pip-version-check --no-compile --prefer-binary -r $<
	@echo '$(CURDIR)/scripts' > $$($(B)/venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/petsam.pth
	touch $@

# what only the tests need; where an optional package has no wheel, its tests are skipped with a message
$(B)/venv/tests-done: tests/requirements.txt tests/requirements-optional.txt $(B)/venv/done
	$(B)/venv/bin/python -m pip install -q --disable-pip-version-check -r $<
	@while read -r package; do \
	  $(B)/venv/bin/python -m pip install -q --disable-pip-version-check "$$package" || echo "not installed: $$package; its tests will be skipped"; \
	done < tests/requirements-optional.txt
	touch $@

test: all units bench-programs $(B)/venv/tests-done ## run all tests but the slow ones (about 12 minutes on two cores)
	$(PYTHON) tests/run.py --build $(B)

check-slow: all units bench-programs $(B)/venv/tests-done ## run the slow tests that `make test` leaves out, and all others on the ranks that it leaves out
	$(PYTHON) tests/run.py --build $(B) --slow

check-sanitize: ## unit tests under the address and undefined-behaviour sanitizers
	$(MAKE) $(SANITIZE) all units
	ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 UBSAN_OPTIONS=halt_on_error=1 $(PYTHON) tests/run.py --build build/sanitize --units-only

SANITIZE := B=build/sanitize OPT="-O1 -g -fsanitize=address,undefined -fno-omit-frame-pointer" LDFLAGS="-fsanitize=address,undefined"
check-fuzz: all $(B)/venv/tests-done ## fuzzing for ten minutes, without and with sanitizers: malformed input, kills, full disks, signals; ARGS="--seconds 60 --seed 7 --only gap,kill"
	$(B)/venv/bin/python tests/fuzz/fuzz.py --build $(B) $(ARGS)
	$(MAKE) $(SANITIZE) all
	$(B)/venv/bin/python tests/fuzz/fuzz.py --build build/sanitize --patience 180 $(ARGS)

check-valgrind: all units ## unit tests under valgrind, one rank
	for t in $(UNIT); do valgrind -q --error-exitcode=9 $$t > $(B)/valgrind.log 2>&1 || { cat $(B)/valgrind.log; exit 1; }; done

# mpicc takes its compiler from these variables, of Open MPI and of MPICH
check-clang: ## build with clang, warnings as errors, in build/clang; unit tests
	OMPI_CC=clang MPICH_CC=clang $(MAKE) B=build/clang WERROR=1 all units
	$(PYTHON) tests/run.py --build build/clang --units-only

# the newest interface, 64-bit indices, PETSc's own checks; it takes ten minutes to build. PETSC_VERSION= chooses another
NEWEST := $(CURDIR)/build/petsc
check-petsc: $(NEWEST)/done ## build with the newest PETSc on PyPI, warnings as errors, in build/petsc/petsam; unit tests
	$(MAKE) B=$(NEWEST)/petsam PETSC_DIR=$(NEWEST) PETSC_ARCH=newest WERROR=1 all units
	$(PYTHON) tests/run.py --build $(NEWEST)/petsam --units-only

$(NEWEST)/done:
	rm -rf $(NEWEST) && mkdir -p $(NEWEST)
	$(PYTHON) -m venv $(NEWEST)/venv
	$(NEWEST)/venv/bin/python -m pip download -q --no-deps --no-binary :all: -d $(NEWEST) petsc$(PETSC_VERSION:%===%)
	tar -xzf $(NEWEST)/petsc-*.tar.gz -C $(NEWEST) --strip-components=1
	cd $(NEWEST) && $(PYTHON) ./configure PETSC_DIR=$(NEWEST) PETSC_ARCH=newest --with-cc=mpicc --with-cxx=0 --with-fc=0 --with-debugging=1 --with-64-bit-indices=1 --with-x=0 --with-make-np=$$(nproc)
	$(MAKE) -C $(NEWEST) PETSC_DIR=$(NEWEST) PETSC_ARCH=newest all
	touch $@

check-mutants: $(B)/venv/tests-done ## change lines that guard correctness, one at a time; a test must fail each time: ARGS="word ..." for some
	$(PYTHON) tests/mutants/check.py $(ARGS)

check-readmes: all bench-programs $(B)/venv/tests-done ## run the commands in the READMEs and compare what they print: ARGS=--all for the slow ones too, or files
	$(B)/venv/bin/python scripts/maintain/check_readmes.py --build $(B) $(ARGS)

# the format of the sources; the tests' environment has the formatters in fixed versions
C_SOURCES := $(shell find src include tests examples -name '*.[ch]')
PYTHON_SOURCES := scripts examples tests scripts/petsam-plot
format: $(B)/venv/tests-done ## format C and Python by .clang-format and .ruff.toml
	@$(B)/venv/bin/clang-format -i $(C_SOURCES)
	@$(B)/venv/bin/ruff format -q $(PYTHON_SOURCES)

check-format: $(B)/venv/tests-done ## check the format of C and Python, the type hints of the Python package, the words of texts, the comments of public functions, and decisions by one rank's own data
	@$(B)/venv/bin/clang-format --dry-run -Werror $(C_SOURCES)
	@awk 'length > 120 {print FILENAME ":" FNR ": more than 120 columns"; n++} END {exit n > 0}' $(C_SOURCES)
	@$(B)/venv/bin/ruff format -q --check $(PYTHON_SOURCES)
	@$(B)/venv/bin/ruff check -q --no-cache $(PYTHON_SOURCES)
	@$(B)/venv/bin/python -m mypy --config-file scripts/pyproject.toml --cache-dir $(B)/mypy --no-error-summary
	@$(PYTHON) scripts/maintain/check_words.py
	@$(PYTHON) scripts/maintain/functions.py --check
	@$(PYTHON) scripts/maintain/check_ranks.py

lint: $(PROGRAMS:%=$(B)/help/%.h) ## cppcheck over the sources
	cppcheck -q --std=c11 --enable=warning,portability --error-exitcode=1 --inline-suppr -Iinclude -I$(B) --suppress=missingInclude --suppress=unknownMacro --suppress=ctuArrayIndex $(LIB_SRC) $(APP_SRC) $(PROGRAMS:%=src/front/app/%.c)

# what is installed for users; scripts that build and maintain petsam are not
SHARED = $(shell find scripts examples -type f ! -path '*/maintain/*' ! -path '*/__pycache__/*' ! -name setup.py ! -name install-dependencies.sh ! -name quickstart.sh)
share  = $(DESTDIR)$(prefix)/share/petsam
# the manual's parts outside of scripts and examples
MANUAL := README.md CHANGES.md src/README.md tests/README.md tests/bench/README.md tests/trials/README.md
TRIALS := $(sort $(wildcard tests/trials/*.[ch]))

install: all pages ## install program, library, headers, petsam.pc, scripts, examples, man pages, completions: prefix=, DESTDIR=
	install -d $(DESTDIR)$(prefix)/bin $(DESTDIR)$(prefix)/lib/pkgconfig
	install -m 755 $(PROGRAMS:%=$(B)/bin/%) $(DESTDIR)$(prefix)/bin
	install -D -m 755 $(EXAMINE) $(DESTDIR)$(prefix)/lib/petsam/$(notdir $(EXAMINE))
	install -m 644 $(B)/lib/libpetsam.a $(DESTDIR)$(prefix)/lib
	install -m 755 $(B)/lib/libpetsam.so.$(VERSION) $(DESTDIR)$(prefix)/lib
	cd $(DESTDIR)$(prefix)/lib && ln -sf libpetsam.so.$(VERSION) $(SONAME) && ln -sf $(SONAME) libpetsam.so
	for f in $(HEADERS); do install -D -m 644 $$f $(DESTDIR)$(prefix)/$$f || exit 1; done
	printf 'prefix=%s\nName: petsam\nDescription: partial-slip contact by the semi-analytical method\nVersion: %s\nRequires: petsc\nRequires.private: fftw3 %s\nCflags: -I$${prefix}/include\nLibs: -L$${prefix}/lib -lpetsam\nLibs.private: -lfftw3_mpi -lfftw3f_mpi -lfftw3f -lhdf5_hl -lm\n' '$(prefix)' '$(VERSION)' '$(HDF5_PC)' > $(DESTDIR)$(prefix)/lib/pkgconfig/petsam.pc
	for f in $(SHARED); do install -D -m $$(test -x $$f && echo 755 || echo 644) $$f $(share)/$$f || exit 1; done
	for f in $(LINKS); do ln -sf petsam-plot $(share)/scripts/$$f || exit 1; done
	for f in $(TOOLS); do ln -sf ../share/petsam/scripts/$$f $(DESTDIR)$(prefix)/bin/$$f || exit 1; done
	for f in $(MANUAL) $(TRIALS); do install -D -m 644 $$f $(share)/$$f || exit 1; done
	install -m 644 LICENSE CITATION.cff $(share)
	for f in $(PAGES); do [ ! -e $(B)/share/$$f ] || install -D -m 644 $(B)/share/$$f $(DESTDIR)$(prefix)/share/$$f || exit 1; done
	for f in $(TOOLS); do \
	  install -D -m 644 scripts/maintain/tools.bash $(DESTDIR)$(prefix)/share/bash-completion/completions/$$f || exit 1; done

# man pages and bash's completions, from what the programs say of themselves; `make install PAGES=` where they cannot run
PAGES := $(foreach p,$(PROGRAMS),man/man1/$p.1 bash-completion/completions/$p) $(TOOLS:%=man/man1/%.1)

pages: $(PAGES:%=$(B)/share/%) ## make the man pages, the completions of options, and, in a clone, the tables of options in the manual
	$(if $(wildcard .git),$(Q)$(PYTHON) scripts/maintain/reference.py --build $(B))

$(B)/share/man/man1/%.1: $(B)/bin/% scripts/maintain/manpage.py scripts/maintain/options.py
	@mkdir -p $(@D)
	$(say) MAN $@
	$(Q)$(PYTHON) scripts/maintain/manpage.py $< > $@

# a script prints its --help only where Python has its libraries; elsewhere a message says so, and it has no page
$(TOOLS:%=$(B)/share/man/man1/%.1): $(B)/share/man/man1/%.1: scripts/% scripts/maintain/manpage.py scripts/maintain/options.py $(shell find scripts/petsam -name "*.py")
	@mkdir -p $(@D)
	$(say) MAN $@
	$(Q)$(PYTHON) scripts/maintain/manpage.py $< > $@ || rm -f $@

$(B)/share/bash-completion/completions/%: $(B)/bin/% scripts/maintain/completion.py scripts/maintain/options.py
	@mkdir -p $(@D)
	$(say) COMPLETION $@
	$(Q)$(PYTHON) scripts/maintain/completion.py $< > $@

# built anew by zig against libraries of its own, all below build/wheel; the environment's Python has pip. zig's linker lacks
# -Bsymbolic-functions. Binding data too is safe where all code is compiled with -fPIC, as petsam's and that of plugins is
WHEEL     := build/wheel
LIBRARIES := $(CURDIR)/$(WHEEL)/libraries
wheel: $(B)/venv/done ## make a wheel in build/wheel that carries programs and libraries and takes MPI from PyPI
	scripts/packaging/wheel-libraries.sh $(LIBRARIES)
	PATH="$(LIBRARIES)/bin:$$PATH" MPICH_CC=zig-cc PKG_CONFIG_LIBDIR=$(LIBRARIES)/lib/pkgconfig $(MAKE) B=$(WHEEL)/petsam \
	  PETSC_DIR= CC=mpicc OPT=-O3 BIND=-Wl,-Bsymbolic CFLAGS=-I$(LIBRARIES)/include \
	  LDFLAGS="-L$(LIBRARIES)/lib -Wl,-rpath,$(LIBRARIES)/lib" all pages
	$(B)/venv/bin/python scripts/packaging/wheel.py --build $(WHEEL)/petsam --libraries $(LIBRARIES)

# the pages as a site that can be searched; a link that leads nowhere is an error
site: $(B)/site-venv/done ## make the site of all pages in build/site: URL=https://example.org/petsam/ for a folder of a server
	$(B)/site-venv/bin/python scripts/maintain/site_pages.py --pages $(B)/site-pages --out $(B)/site --url '$(URL)'
$(B)/site-venv/done: scripts/maintain/site.txt
	@mkdir -p $(B)
	$(PYTHON) -m venv $(B)/site-venv
	$(B)/site-venv/bin/python -m pip install -q --disable-pip-version-check -r $<
	touch $@

clean: ## remove what was built
	rm -rf $(B)

-include $(shell find $(B)/obj -name "*.d" 2>/dev/null)
