#!/bin/bash
# What light through leaves costs in the leaf's shader: instructions of src/shaders/plant_pass.frag,
# its terms frozen as a draw of a leaf has them and optimised (spirv-opt of Debian's spirv-tools), by
# kind: arithmetic on scalars and vectors alike, reads of textures, and branches. Loads, stores and
# the composition of vectors are left out: on most hardware they are no instructions.
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
glslc --target-env=vulkan1.2 -O -Isrc -o "$work/whole.spv" src/shaders/plant_pass.frag

# NAME CONSTANTS: prints one row.
count() {
  local leaf="4:true 5:2 8:true 9:true 10:true 11:true 14:true 17:2" settings
  settings=$(printf '%s\n' $leaf ${2-} | tac | sort -t: -k1,1n -u -s | tr '\n' ' ')
  spirv-opt --set-spec-const-default-value "$settings" --freeze-spec-const \
    --fold-spec-const-op-composite -O -O "$work/whole.spv" \
    -o "$work/frozen.spv"
  spirv-dis --raw-id "$work/frozen.spv" | awk -v name="$1" '
    { op = $2 == "=" ? $3 : $1 }
    op == "OpFunction" { inside = 1 }
    !inside { next }
    op ~ /^OpImageSample|^OpImageGather|^OpImageFetch/ { reads++; next }
    op ~ /^OpBranchConditional|^OpSwitch/ { branches++; next }
    op ~ /^Op(F|I|S|U)(Add|Sub|Mul|Div|Mod|Rem|Negate|Ord|Unord|LessThan|GreaterThan|Equal|NotEqual)/ ||
    op ~ /^Op(Dot|VectorTimes|MatrixTimes|ExtInst|Select|Logical|Any|All|Shift|Bitwise|Convert|DPdx|DPdy|Fwidth)/ {
      arithmetic++ }
    END { printf "%-44s %5d %8d %9d\n", name, arithmetic, reads, branches }'
}

printf '%-44s %5s %8s %9s\n' "" ALU textures branches
echo "as preset habel draws a leaf with maps"
count "  light through it as it falls (3.23)"
count "  scattered evenly (3.24)" 17:1
count "  by its colour alone, one texture" 17:0
count "  no light through it" 8:false
echo "the sun alone, without shadow"
count "  light through it as it falls (3.23)" "0:false 3:false"
count "  scattered evenly (3.24)" "0:false 3:false 17:1"
count "  by its colour alone, one texture" "0:false 3:false 17:0"
count "  no light through it" "0:false 3:false 8:false"
count "  neither light through it nor gloss" "0:false 2:false 3:false 8:false"
