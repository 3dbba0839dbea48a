# The printed code with fused products in dense layers and in pow2 (annex E, "fused").
s/acc = acc + \(from_bits(w\[o \* in + k\])\) \* \(x\[k\]\);/acc = fmaf(\1, \2, acc);/
s/ p = p \* f + \([^;]*\);/ p = fmaf(p, f, \1);/
