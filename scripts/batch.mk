# `make batch` runs this with the program built: a mesh and a result for each line of the list.
# Like every make, it compares the times of files: what is newer than its result makes the result again.

list := geo/batch.txt
program := target/release/coralpipe

all: # what it needs is known once the list is read, below

# Which variants there are, and the script and case of each.
output/batch.mk: $(list) scripts/batch.py $(wildcard geo/*.json)
	@mkdir -p output
	@scripts/batch.py rules $(list) > $@
include output/batch.mk

# In a folder of the batch's own: a run by hand that calls itself the same is none of its variants.
results := $(variants:%=output/batch/%/summary.json)
all: $(results)

# A run that did not converge, or that was interrupted, leaves a summary too, but one that does not say "done".
unfinished := $(shell grep -sL '"status": "done"' $(results))
$(unfinished): FORCE
FORCE:

# coralpipe leaves a mesh alone whose script and parameters are the same as before; then it only gets the new time.
meshes/%.msh:
	@echo "mesh $*"
	@mkdir -p output/batch/$*
	@$(program) mesh $(case) $(geo) > output/batch/$*/batch.log 2>&1 && touch $@

# The constants and not the mesh are handed on: the run then looks whether the mesh is still theirs.
output/batch/%/summary.json: meshes/%.msh $(program)
	@echo "run  $*"
	@mkdir -p $(@D)
	@$(program) run $(case) $(geo) --out $(@D) > $(@D)/batch.log 2>&1

.DELETE_ON_ERROR:
.PRECIOUS: meshes/%.msh output/batch/%/summary.json
