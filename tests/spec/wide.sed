# The printed code in binary64 (annex E, "wide"). A pattern stays a binary32 number.
/^static float from_bits/,/^}/ {
    s/^static float/static double/
    b
}
s/\<float\>/double/g
s/\<sqrtf\>/sqrt/g
s/\<floorf\>/floor/g
