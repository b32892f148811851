"""The paper's equations, as printed and as they are right: one file a chapter. They need no simulator."""
