"""The audit compares each claim of the paper with a witness, mostly MuJoCo: one file a chapter of the paper."""
