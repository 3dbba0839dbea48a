# The printed code with four sums in dense layers and with reciprocals (annex E, "reordered").
s/float acc = from_bits(w\[in \* out + o\]);/float acc = from_bits(w[in * out + o]), part[4] = { 0.0f, 0.0f, 0.0f, 0.0f };/
s/acc = acc + \(from_bits(w\[o \* in + k\]) \* x\[k\]\);/part[k % 4] = part[k % 4] + \1;/
s/to\[o\] = last ? acc : max_of(0.0f, acc);/acc = acc + ((part[0] + part[1]) + (part[2] + part[3]));\
            &/
s|(float)(g % den) / (float)den|(float)(g % den) * (1.0f / (float)den)|
s|(float)num / (float)den|(float)num * (1.0f / (float)den)|
s|u = (t - a) / b;|u = (t - a) * (1.0f / b);|
s|v\[j\] / sum|v[j] * (1.0f / sum)|
