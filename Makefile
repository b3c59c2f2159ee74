# make          sets up what is missing, builds, meshes, solves; the results are in output/twin_pipes/
# make test     every test
# make batch    all variants of geo/batch.txt, with -j2 two at a time; the table is output/batch.csv
# make book     the verification book: every case with an exact answer, written to docs/verification/
# make bench    what a step costs, against what memory allows and against a linear step; BENCH=full adds 1,000,000 unknowns
# make bench-peers  the same case by OpenSees, SciPy and Kratos, which it installs into .venv-bench
#                   with either, RECORD=1 writes its section of docs/performance.md
# make picture  the README's picture, by ParaView
# make clean    removes what was built and computed; the default mesh, and meshes of your own, stay

program := target/release/coralpipe
python := .venv/bin/python
sources := $(shell find src -name '*.rs') Cargo.toml Cargo.lock

.PHONY: all setup test batch book bench bench-peers picture clean
all: setup $(program)
	$(program) run

setup:
	@scripts/setup.sh

$(program): $(sources) | setup
	cargo build --release --locked
	@touch $@

test: setup $(program)
	cargo fmt --all --check
	cargo clippy --release --all-targets --locked -- --deny warnings
	cargo test --release --locked --no-fail-fast
	$(python) scripts/check_licences.py
	$(python) scripts/check_schema.py --binary $(program)
	$(program) mesh
	$(python) scripts/check_mesh.py meshes/twin_pipes.msh --case geo/twin_pipes.json
	$(program) run --quiet --out output/test
	$(python) scripts/check_output.py output/test
	$(program) run --quiet --set gravity=9.81 --set time.end='"10 ms"' --out output/test_gravity
	$(python) scripts/check_output.py output/test_gravity
	$(python) scripts/check_gallery.py --binary $(program)
	$(python) scripts/random_geometries.py 50 2026 --binary $(program)
	$(python) scripts/random_twins.py 30 2026 --binary $(program)
	PYTHONPATH=scripts $(python) -m book --quick

book: setup $(program)
	PYTHONPATH=scripts $(python) -m book

bench: setup
	@mkdir -p target
	cargo bench --locked --bench table > target/bench.md
	@cat target/bench.md
	$(if $(RECORD),$(python) scripts/bench/record.py bench < target/bench.md)

bench-peers: setup $(program)
	scripts/bench/setup.sh
	$(program) mesh
	PYTHONPATH=scripts .venv-bench/bin/python -m bench $(if $(RECORD),--record)

# Continues where a variant fails, so that the table holds the others; failures are reported at the end.
batch: setup $(program)
	@$(MAKE) --no-print-directory --keep-going --file scripts/batch.mk; made=$$?; \
	$(python) scripts/batch.py table geo/batch.txt output/batch.csv && exit $$made

# A display server that was just closed can refuse the next one: then once more.
picture: all
	for try in 1 2 3; do \
	    xvfb-run -a pvpython scripts/render.py output/twin_pipes docs/twin_pipes.png --time 0.09 --range 0.6 1.2 && exit 0; sleep 2; done; exit 1

clean:
	cargo clean
	rm -rf output
	@grep -ls '"mesh_sha256"' meshes/*.json | grep -vx 'meshes/twin_pipes.json' | while read -r record; do \
	    rm -f "$$record" "$${record%.json}.msh"; done
	@grep -ls '^coralpipe orders' meshes/*.orders | xargs -r rm -f
