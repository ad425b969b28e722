# rattle: make, make run, make test. Everything else: make help.
#
#   MPI=1        campaigns over the ranks of an MPI job (needs Open MPI)
#   NATIVE=1     compile for this very processor instead of any x86-64-v3
#   BUILD=DIR    build folder (default: build)
#   FC=COMPILER  gfortran, or flang of LLVM 19 or later
#   PREFIX=DIR   below which make install puts program, Python package, man page and completion

BUILD ?= build
PREFIX ?= /usr/local
SCRIPTS_PLACE := bin
PACKAGES_PLACE := lib/rattle
VERSION := $(shell cat fsrc/VERSION)
FC := $(if $(MPI),mpifort,gfortran)
PYTHON_ENV := .venv
PYTHON := $(PYTHON_ENV)/bin/python

# --- set-up: only looks, unless something is missing. It comes before everything that asks for a library.

ifeq ($(filter clean help uninstall,$(MAKECMDGOALS))$(SYSTEM_LOOKED_AT),)
  ifneq ($(shell scripts/setup_system.sh >&2 && echo ready),ready)
    $(error the system lacks what is named above)
  endif
endif
export SYSTEM_LOOKED_AT := yes

UNAME_MACHINE := $(shell uname -m)
ARCHITECTURE := $(if $(NATIVE),-march=native,$(if $(filter x86_64,$(UNAME_MACHINE)),-march=x86-64-v3,))
FFTW_INCLUDE := $(firstword $(wildcard /usr/include/fftw3.f03 $(CONDA_PREFIX)/include/fftw3.f03 $(FFTW_ROOT)/include/fftw3.f03))
LIBRARIES := $(if $(FFTW_ROOT),-L$(FFTW_ROOT)/lib) $(if $(CONDA_PREFIX),-L$(CONDA_PREFIX)/lib) -lfftw3 -llapack -lblas

# Flags of each compiler.
# Not -ffast-math: it drops the tests for NaN, and at link time sets flush-to-zero for the whole process.
# -flto lets the film kernels become part of the loops over time, which live in other files.
# The loops over lanes run in full registers as they stand; made part of the loop over steps, gfortran 12 leaves some of
# them scalar. Elementary functions run so only as part of the loops that call them, which gfortran finds too long. What films
# with a state of their own need stays apart from the steps of those without.
ifneq ($(findstring flang,$(FC)),)
  WARNINGS := -std=f2018
  RELEASE_FLAGS := -O3 $(ARCHITECTURE) -fopenmp -fPIC
  DEBUG_FLAGS := -O1 -g -fopenmp -fPIC
else
  WARNINGS := -std=f2018 -Wall -Wextra $(if $(STRICT),-Werror)
  RELEASE_FLAGS := -O3 $(ARCHITECTURE) -fno-math-errno -fno-trapping-math -flto=auto -fopenmp -fPIC \
    $(if $(PROFILE),-fno-omit-frame-pointer)
  DEBUG_FLAGS := -O1 -g -fcheck=all,no-array-temps -finit-real=snan -ffpe-trap=invalid,overflow,zero -fbacktrace -fopenmp -fPIC
  LANE_FLAGS := $(if $(DEBUG),,-fno-inline)
  ELEMENTARY_FLAGS := -finline-limit=4000
  APART_FLAGS := -fno-lto
  WIDENING := -Wconversion-extra
endif
STRICT_FLAGS := -O1 -fopenmp
SANITIZE_FLAGS := -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer -fopenmp -fPIC
FFLAGS := $(WARNINGS) $(if $(DEBUG),$(DEBUG_FLAGS),$(if $(STRICT),$(STRICT_FLAGS),$(if $(SANITIZE),$(SANITIZE_FLAGS),$(RELEASE_FLAGS)))) $(addprefix -I,$(dir $(FFTW_INCLUDE)))

# Whether the compiler uses registers of eight numbers: they are filled from rows of tables in a way of their own.
WIDE_REGISTERS := $(shell $(FC) $(ARCHITECTURE) -Q --help=target 2>/dev/null | awk '\
  $$1 == "-mavx512f" && $$2 == "[enabled]" { wide = 1 } \
  $$1 == "-mprefer-vector-width=" && $$2 ~ /^(128|256)$$/ { narrow = 1 } \
  END { print wide && !narrow ? ".true." : ".false." }')
# The folders of fsrc that the program is made of; each uses only those before it.
MODULES := foundation scene gear film contact problem motion orbit spectrum verdict files judgement run campaign
# Folders within folders that this build takes.
PARTS := film/coefficients campaign/$(if $(MPI),mpi,serial)
FOLDERS := $(foreach folder,$(MODULES),$(folder) $(filter $(folder)/%,$(PARTS)))
SOURCES := $(foreach folder,$(FOLDERS),$(sort $(wildcard fsrc/$(folder)/*.f90))) $(BUILD)/ready_inputs.f90
# What rattle --template NAME prints.
READY_INPUTS := motion=input/loose_pair.nml gearbox=input/gearbox.nml film=input/film.nml sweep=input/sweep.nml \
  campaign=input/map.nml threshold=input/threshold.nml
OBJECTS := $(patsubst %.f90,$(BUILD)/%.o,$(notdir $(SOURCES)))
UNIT_SOURCES := $(sort $(wildcard tests/unit/*.f90)) $(BUILD)/unit_suites.f90
UNIT_OBJECTS := $(patsubst %.f90,$(BUILD)/%.o,$(notdir $(UNIT_SOURCES)))
BENCH_SOURCES := $(sort $(wildcard tests/benchmarks/*.f90))
BENCH_PROGRAMS := $(patsubst %.f90,$(BUILD)/%,$(notdir $(BENCH_SOURCES)))

STRESS_PROGRAMS := $(addprefix $(BUILD)/,stress_scenes stress_summaries stress_motions lane_independence newmark_outcomes reported_motions)
STRESS_SOURCES := $(sort $(filter-out $(STRESS_PROGRAMS:$(BUILD)/%=tests/stress/%.f90),$(wildcard tests/stress/*.f90)))
STRESS_OBJECTS := $(patsubst %.f90,$(BUILD)/%.o,$(notdir $(STRESS_SOURCES)))

VPATH := $(addprefix fsrc/,$(FOLDERS)) fsrc tests/unit tests/benchmarks tests/stress

.DEFAULT_GOAL := all
.PHONY: all run test test-long unit unit-debug user user-long lint debug python bench bench-build bench-changed profile trends measured hashes stress stress-sample faults faults-sample touched sanitize mutants release-check doc test-cluster compilers clean install uninstall help format pages pictures FORCE

all: $(BUILD)/rattle

help:
	@echo 'make              build the program as $(BUILD)/rattle'
	@echo 'make run          solve the two scenes of the paper, draw its figures, compare idle with creep'
	@echo 'make test         unit tests and user tests: about five minutes on two cores'
	@echo 'make test-long    user tests that take long, samples of the studies of stress and faults'
	@echo 'make lint         compiler warnings, rules of the layout, style of Fortran and Python'
	@echo 'make debug        build with every run-time check as $(BUILD)/debug/rattle'
	@echo 'make python       Python environment and the module of the Fortran kernels'
	@echo 'make trends       trends that test stands report, as the program has them'
	@echo 'make measured     what was measured of rebound and onset beside what the program computes'
	@echo 'make hashes       hashes of what many runs write, as $(BUILD)/hashes.json, or held against those of another build (AGAINST=FILE)'
	@echo 'make bench        speed of the program beside that of others, as tables; make bench-changed: its last'
	@echo 'make profile      where a campaign spends its time: by phase, kind of row, procedure; needs perf of Linux'
	@echo 'make stress       100000 random scenes: what users are reported of them, and every engine (SCENES=N)'
	@echo 'make mutants      break lines changed since SINCE=HEAD~20 in one place at a time: does a test notice? (SAMPLE=40)'
	@echo 'make faults       runs that meet kills, full disks, little memory, failing calls, other runs, damaged and foreign files'
	@echo 'make touched      how many files a new law, quantity, key, task or figure takes, by toys in a scratch copy'
	@echo 'make sanitize     unit tests and small inputs under the sanitizers of the compiler for addresses and undefined behaviour'
	@echo 'make test-cluster campaigns under Open MPI and Slurm on this machine'
	@echo 'make compilers    gfortran 14 and flang 19 in a Debian 13 of their own, against the program of this machine'
	@echo 'make pages        write the tables of input/KEYS.md and scripts/rattle/quantities.csv anew'
	@echo 'make pictures     draw the pictures of the README anew'
	@echo 'make format       bring Fortran and Python into the one format'
	@echo 'make install      install program, Python package, man page and completion below PREFIX=$(PREFIX)'
	@echo 'make uninstall    remove what make install put below PREFIX=$(PREFIX)'
	@echo 'make doc          one site of all pages, the Python API and the Fortran code, with search, as $(BUILD)/doc/index.html'
	@echo 'make release-check  version, CHANGELOG, CITATION and tag agree; prints the text of the tag'
	@echo 'make clean        remove everything that was built'

# --- Python packages --------------------------------------------------------------------------------

$(PYTHON_ENV)/installed: pyproject.toml scripts/setup_python.sh scripts/requirements.txt
	@scripts/setup_python.sh $(PYTHON_ENV)

# --- program ----------------------------------------------------------------------------------------

# A change of compiler or flags changes this file, and with it rebuilds everything.
$(BUILD)/flags: FORCE
	@mkdir -p $(BUILD)
	@{ $(FC) --version | head -1; echo '$(FFLAGS) $(LIBRARIES)'; echo '$(FOLDERS)'; } > $@.new
	@cmp -s $@.new $@ && rm $@.new || mv $@.new $@

# Which object needs which module, read off the use statements.
$(BUILD)/depends.mk: $(SOURCES) $(UNIT_SOURCES) $(STRESS_SOURCES) fsrc/main.f90 Makefile
	@mkdir -p $(BUILD)
	@awk -v build=$(BUILD) 'FNR == 1 { name = FILENAME; sub(/.*\//, "", name); sub(/\.f90$$/, "", name); known[name] = 1 } \
	  tolower($$1) == "use" && $$2 !~ /^,/ { module = tolower($$2); sub(/,.*/, "", module); needs[name] = needs[name] " " module } \
	  END { for (name in needs) { count = split(needs[name], list, " "); \
	    for (i = 1; i <= count; i++) if ((list[i] in known) && list[i] != name) print build "/" name ".o: " build "/" list[i] ".o" } }' \
	  $(SOURCES) $(UNIT_SOURCES) $(STRESS_SOURCES) fsrc/main.f90 > $@

# A module includes the body of its blocks from a file of its own name.
$(foreach body,$(wildcard fsrc/*/*.inc),$(eval $(patsubst %.inc,$(BUILD)/%.o,$(notdir $(body))): $(body)))

ifeq ($(filter clean help lint format uninstall,$(MAKECMDGOALS)),)
-include $(BUILD)/depends.mk
endif

$(BUILD)/%.o: %.f90 $(BUILD)/flags
	@echo 'compile $<'
	@$(FC) $(FFLAGS) -J$(BUILD) -c $< -o $@

# The folders that compute may not even widen a kind unseen. (Elsewhere gfortran 12 warns of text positions.)
COMPUTING := $(foreach folder,$(filter-out foundation scene files judgement run campaign,$(MODULES)),$(wildcard fsrc/$(folder)/*.f90))
$(patsubst %.f90,$(BUILD)/%.o,$(notdir $(COMPUTING))): private FFLAGS += $(if $(STRICT),$(WIDENING))

$(addprefix $(BUILD)/,film_series.o lane_advance.o lane_integration.o step_nodes.o taylor_iso_viscous.o taylor_piezo_viscous.o \
  taylor_reynolds_piezo.o): private FFLAGS += $(LANE_FLAGS)
# gfortran 12 negates the stride, never set, of an optional array that is absent and handed on; nobody reads what comes of it.
$(BUILD)/lane_integration.o: private FFLAGS += $(if $(SANITIZE),-fno-sanitize=signed-integer-overflow)
$(BUILD)/lane_functions.o $(BUILD)/elementary_functions.o: private FFLAGS += $(ELEMENTARY_FLAGS)
$(BUILD)/inner_equations.o: private FFLAGS += $(APART_FLAGS)

$(BUILD)/lane_rows.o: private FFLAGS += -cpp -DWIDE_REGISTERS=$(WIDE_REGISTERS)
$(BUILD)/version.o: private FFLAGS += -cpp -DPROGRAM_VERSION='"$(VERSION)"'
$(BUILD)/version.o: fsrc/VERSION

$(BUILD)/rattle: $(OBJECTS) $(BUILD)/main.o
	@echo 'link $@'
	@$(FC) $(FFLAGS) $^ $(LIBRARIES) -o $@

# The suites of unit tests are the files that are there.
$(BUILD)/unit_suites.f90: FORCE
	@mkdir -p $(BUILD)
	@tests/unit/write_suites.sh > $@.new
	@cmp -s $@.new $@ && rm $@.new || mv $@.new $@

$(BUILD)/ready_inputs.f90: scripts/write_ready_inputs.sh Makefile $(foreach pair,$(READY_INPUTS),$(lastword $(subst =, ,$(pair))))
	@mkdir -p $(BUILD)
	@scripts/write_ready_inputs.sh $(READY_INPUTS) > $@

$(BUILD)/unit_suites.o $(BUILD)/ready_inputs.o: $(BUILD)/%.o: $(BUILD)/%.f90 $(BUILD)/flags
	@echo 'compile $<'
	@$(FC) $(FFLAGS) -J$(BUILD) -c $< -o $@

$(BUILD)/unit_tests: $(OBJECTS) $(UNIT_OBJECTS)
	@echo 'link $@'
	@$(FC) $(FFLAGS) $^ $(LIBRARIES) -o $@

$(BENCH_PROGRAMS): $(BUILD)/%: %.f90 $(OBJECTS)
	@echo 'link $@'
	@$(FC) $(FFLAGS) -J$(BUILD) $< $(OBJECTS) $(LIBRARIES) -o $@

# --- Python: the module of the kernels, beside the package -------------------------------------------

python: $(BUILD)/kernels/built

$(BUILD)/kernels/built: $(wildcard fsrc/bindings/*.f90) scripts/build_kernels.sh $(OBJECTS) $(PYTHON_ENV)/installed
	@echo 'build the Python module of the kernels'
	@scripts/build_kernels.sh $(PYTHON) $(BUILD)/kernels '$(OBJECTS)' '$(LIBRARIES)' '$(FC)' $(BUILD) scripts/rattle
	@touch $@

# --- the two scenes of the paper ---------------------------------------------------------------------

run: $(BUILD)/rattle $(BUILD)/kernels/built
	@$(BUILD)/rattle --overwrite input/idle.nml input/creep.nml
	@$(PYTHON) scripts/plot.py motion --overwrite results/idle.rattle results/creep.rattle --output results
	@$(PYTHON) scripts/compare.py results/idle.summary.nml results/creep.summary.nml

# --- tests: the unit tests, then what a user does ----------------------------------------------------

# What takes long, a build in another place, a browser, faults and samples of the studies, is left to test-long.
test:
	@$(MAKE) --no-print-directory -j2 $(BUILD)/rattle $(BUILD)/unit_tests $(BUILD)/kernels/built
	@$(MAKE) --no-print-directory unit user
test-long: unit-debug user-long touched stress-sample faults-sample

unit: $(BUILD)/unit_tests
	@echo 'unit tests, release build'
	@$(BUILD)/unit_tests

unit-debug:
	@$(MAKE) --no-print-directory BUILD=$(BUILD)/debug DEBUG=1 $(BUILD)/debug/unit_tests $(BUILD)/debug/rattle
	@echo 'unit tests, debug build with every run-time check'
	@$(BUILD)/debug/unit_tests

USER_TESTS = RATTLE_PROGRAM=$(abspath $(BUILD)/rattle) $(PYTHON) -m pytest -n $(shell nproc) --dist loadfile
user: $(BUILD)/rattle $(BUILD)/unit_tests $(BUILD)/kernels/built
	@echo 'user tests'
	@$(USER_TESTS) -m 'not long'

user-long: $(BUILD)/rattle $(BUILD)/unit_tests $(BUILD)/kernels/built
	@echo 'user tests that take long'
	@$(USER_TESTS) -m long

# --- longer studies ----------------------------------------------------------------------------------

# For this very processor, beside the portable build. The other solvers live in an environment of their own; one that
# cannot be had is named and left out. ROUNDS and LIMIT [s] say how much patience the comparison has. bench-changed is its part
# with several orders, two flanks and elastic teeth.
NATIVE_BUILD := $(BUILD)/native
NATIVE_BENCHES := bench_motion bench_film bench_engine
PEER_ENV := .venv-bench
PEERS := tests/benchmarks/peers
ROUNDS := 3
LIMIT := 0.5
ENGINE := $(NATIVE_BUILD)/bench_engine
# $(call against_peers,NAME,OPTIONS): time against error as NAME.csv, NAME.png and NAME.md, which is printed
define against_peers
	@$(PEER_ENV)/bin/python $(PEERS)/run_peers.py $(2) --output $(BUILD)/$(1).csv --rounds $(ROUNDS) --limit $(LIMIT) \
	  --own 'rattle=$(ENGINE) taylor' --own 'rattle, every period=$(ENGINE) taylor-every-period' \
	  --own 'rattle until steady=$(ENGINE) taylor-steady' --flags $(NATIVE_BUILD)/flags
	@$(PEER_ENV)/bin/python $(PEERS)/plot_work_precision.py $(BUILD)/$(1).csv --base 'rattle, every period' \
	  --figure $(BUILD)/$(1).png --table $(BUILD)/$(1).md
endef

bench: bench-build
	@$(PYTHON) tests/benchmarks/bench_newmark.py $(NATIVE_BUILD)/rattle $(NATIVE_BUILD)/bench_motion $(NATIVE_BUILD)/flags
	@$(NATIVE_BUILD)/bench_film
	$(call against_peers,work_precision)
	@$(PYTHON) tests/benchmarks/bench_skips.py $(NATIVE_BUILD)/rattle
	@$(PYTHON) tests/benchmarks/bench_drag.py $(NATIVE_BUILD)/rattle
	@$(PEER_ENV)/bin/python $(PEERS)/bench_nodes.py $(NATIVE_BUILD)/rattle --rounds $(ROUNDS) --flags $(NATIVE_BUILD)/flags
	@$(PYTHON) tests/benchmarks/bench_closure.py $(NATIVE_BUILD)/rattle --rounds $(ROUNDS)
	@$(PEER_ENV)/bin/python $(PEERS)/bench_campaign.py $(NATIVE_BUILD)/rattle
	@$(PEER_ENV)/bin/python $(PEERS)/bench_gearbox.py $(NATIVE_BUILD)/rattle --count 9,9,7,7 --sample 32
	@$(MAKE) --no-print-directory bench-changed

bench-changed: bench-build
	$(call against_peers,work_precision_changed,--changed --finest 1e-8 --only 'heyoka 8' --only CVODE)

# Where a campaign spends its time, by samples of its stacks.
profile: $(BUILD)/kernels/built
	@$(MAKE) --no-print-directory BUILD=$(BUILD)/profile PROFILE=1 $(BUILD)/profile/rattle
	@$(PYTHON) tests/benchmarks/bench_phases.py $(BUILD)/profile/rattle

# What the program says of the trends that test stands report: table and picture of tests/trends.
trends: $(BUILD)/rattle $(BUILD)/kernels/built
	@$(PYTHON) tests/page_tables.py tests/trends/README.md

# What was measured beside what the program computes: tables and pictures of tests/measured.
measured: $(BUILD)/rattle $(BUILD)/kernels/built
	@$(PYTHON) tests/page_tables.py tests/measured/README.md

# Do two builds write the same results? Of the one: make hashes; of the other: make hashes AGAINST=FILE. Two minutes on two cores.
hashes: $(BUILD)/rattle $(PYTHON_ENV)/installed
	@$(PYTHON) tests/reference/result_hashes.py $(BUILD)/rattle $(if $(AGAINST),--against $(AGAINST),--write $(BUILD)/hashes.json)

bench-build: $(PYTHON_ENV)/installed
	@$(MAKE) --no-print-directory BUILD=$(NATIVE_BUILD) NATIVE=1 $(addprefix $(NATIVE_BUILD)/,rattle $(NATIVE_BENCHES))
	@sh $(PEERS)/setup.sh $(PEER_ENV)

# Random scenes: what their summaries and rows of campaigns tell, against a solution that resolves impacts, and every engine
# against a tighter solution. About an hour and a half on two cores; tests/stress/SUMMARIES.md says what the columns mean.
SCENES := 100000
stress: $(BUILD)/stress_summaries $(BUILD)/stress_scenes $(BUILD)/stress_motions $(BUILD)/lane_independence
	@$(BUILD)/stress_summaries --scenes $(SCENES) --failures $(BUILD)/stress_failures.txt
	@$(BUILD)/stress_scenes --scenes $(SCENES) --csv $(BUILD)/stress.csv
	@$(BUILD)/stress_motions --scenes $$(($(SCENES)/50 + 1)) --csv $(BUILD)/stress_motions.csv
	@$(BUILD)/lane_independence --scenes 3000

# Does a test notice when a changed line is broken in one place? Some minutes for each mutant.
SINCE := HEAD~20
SAMPLE := 40
mutants: $(PYTHON_ENV)/installed
	@$(PYTHON) tests/mutants/run_mutants.py --since $(SINCE) --sample $(SAMPLE) --scratch $(BUILD)/mutants

# Kills, full disks, a fault at every output call, two runs at a time, flipped bits, foreign files. Some minutes.
FAULTS := tests/faults/run_faults.py $(BUILD)/rattle $(BUILD)/faults
faults: $(BUILD)/rattle $(PYTHON_ENV)/installed
	@$(PYTHON) $(FAULTS) --every-call

# A sample of it.
faults-sample: $(BUILD)/rattle $(PYTHON_ENV)/installed
	@echo 'faults, a sample'
	@$(PYTHON) $(FAULTS) --tries 1

# How many files a law, a quantity, a key, a task and a figure take: toys in a scratch copy.
touched: $(BUILD)/kernels/built
	@echo 'files that a change touches'
	@$(PYTHON) tests/touched/run_touched.py $(BUILD)/touched

# Addresses beyond what was allocated, and what the language leaves undefined: the unit tests, and inputs of every task.
# What libraries and the runtime keep until the end is no fault of the program: leaks are not looked for.
SANITIZED := $(BUILD)/sanitize
sanitized = ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 $(SANITIZED)/$(1)
SANITIZED_RUN = $(call sanitized,rattle) --quiet --overwrite --output $(SANITIZED)/results
sanitize:
	@$(MAKE) --no-print-directory BUILD=$(SANITIZED) SANITIZE=1 $(SANITIZED)/unit_tests $(SANITIZED)/rattle
	@$(call sanitized,unit_tests)
	@$(SANITIZED_RUN) $(foreach name,idle creep creep_false_harmonic creep_period_two loose_gear loose_pair engine_cycle gearbox elastohydrodynamic film,input/$(name).nml)
	@$(SANITIZED_RUN) --set sweep.count=5 input/sweep.nml
	@$(SANITIZED_RUN) --set sweep.count=3 input/stiff_or_not.nml
	@$(SANITIZED_RUN) --set campaign.count=4,4 input/map.nml
	@$(SANITIZED_RUN) --set campaign.count=2 input/threshold.nml

# Open MPI and Slurm on this machine: array jobs, MPI jobs, time limits, resume. Some minutes; installs with apt.
test-cluster: $(PYTHON_ENV)/installed
	@PYTHON=$(abspath $(PYTHON)) tests/cluster/run_cluster_tests.sh $(BUILD)/mpi

# Other compilers, in a bare Debian 13 made for it; as root. A quarter of an hour.
compilers: $(BUILD)/rattle $(PYTHON_ENV)/installed
	@PYTHON=$(abspath $(PYTHON)) tests/compilers/run_compilers.sh $(BUILD)

# --- pages and pictures that are kept in the repository ------------------------------------------------

pictures: $(BUILD)/rattle $(BUILD)/newmark_outcomes $(BUILD)/kernels/built
	@scripts/draw_pictures.sh $(BUILD)/rattle $(PYTHON) $(BUILD)/picture_runs

pages: $(BUILD)/rattle
	@$(BUILD)/rattle --keys > $(BUILD)/tables.md
	@sed -i -e '/^<!-- tables/,/^<!-- end of tables/{//!d}' -e '/^<!-- tables/r $(BUILD)/tables.md' input/KEYS.md
	@$(BUILD)/rattle --quantities > scripts/rattle/quantities.csv

release-check:
	@python3 scripts/check_release.py

# Site and code have tools of their own, which tests do not need. A warning of them fails.
# FORD takes a word and colon at the start of a comment for a setting of its own: the colon is written as markup.
DOC_ENV := .venv-doc
$(DOC_ENV)/installed: scripts/setup_python.sh scripts/doc/requirements.txt
	@scripts/setup_python.sh $(DOC_ENV) scripts/doc/requirements.txt

doc: $(DOC_ENV)/installed $(BUILD)/kernels/built
	@$(DOC_ENV)/bin/python -m sphinx -qEW --keep-going -c scripts/doc . $(BUILD)/doc
	@cp $(BUILD)/doc/README.html $(BUILD)/doc/index.html
	@rm -rf $(BUILD)/doc_source && cp -r fsrc $(BUILD)/doc_source
	@find $(BUILD)/doc_source -name '*.f90' -exec sed -i -E 's/(!> +[A-Za-z0-9_-]+):/\1\&#58;/' {} +
	@notes=$$($(DOC_ENV)/bin/ford --include $(dir $(FFTW_INCLUDE)) --output_dir $(abspath $(BUILD)/doc/code) \
	  $(BUILD)/doc_source/ford.md 2>&1) && ! echo "$$notes" | grep -i -A 1 'warning\|error' || { echo 'FORD failed'; exit 1; }
	@echo '$(BUILD)/doc/index.html'

# A sample of the stress study: a silent failure fails it.
stress-sample: $(STRESS_PROGRAMS) $(BUILD)/rattle $(BUILD)/kernels/built
	@echo 'stress, a sample'
	@$(BUILD)/stress_summaries --first 20 --scenes 100 --campaigns 1
	@$(BUILD)/stress_scenes --scenes 300 --csv $(BUILD)/stress_sample.csv
	@$(BUILD)/stress_motions --first 10 --scenes 2
	@$(PYTHON) tests/stress/reported_alike.py $(BUILD)/rattle --groups 4

# --- style -------------------------------------------------------------------------------------------

lint: $(PYTHON_ENV)/installed
	@scripts/lint.sh $(PYTHON_ENV)/bin $(BUILD)

format: $(PYTHON_ENV)/installed
	@scripts/format.sh $(abspath $(PYTHON_ENV))/bin .
	@$(PYTHON_ENV)/bin/ruff check --quiet --fix scripts tests

$(STRESS_PROGRAMS): $(BUILD)/%: %.f90 $(OBJECTS) $(STRESS_OBJECTS)
	@echo 'link $@'
	@$(FC) $(FFLAGS) -J$(BUILD) $< $(OBJECTS) $(STRESS_OBJECTS) $(LIBRARIES) -o $@

debug:
	@$(MAKE) --no-print-directory BUILD=$(BUILD)/debug DEBUG=1 all

# With PYTHON=... the package is for that Python, which must have numpy; else for the one of this folder.
# A name may have blanks: it reaches the script as one word.
ONE_WORD = '$(subst ','\'',$(1))'
install: all $(if $(filter command line,$(origin PYTHON)),,$(PYTHON_ENV)/installed)
	@scripts/install.sh $(call ONE_WORD,$(PYTHON)) $(BUILD) '$(OBJECTS)' '$(LIBRARIES)' '$(FC)' \
	  $(call ONE_WORD,$(DESTDIR)$(PREFIX)) $(SCRIPTS_PLACE) $(PACKAGES_PLACE)

uninstall:
	@scripts/uninstall.sh $(call ONE_WORD,$(DESTDIR)$(PREFIX)) $(PACKAGES_PLACE)

clean:
	rm -rf $(BUILD) scripts/rattle/*.so

FORCE:
