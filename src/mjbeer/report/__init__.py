"""`mjbeer report`: checks, films and stories on one page. Only `cli` uses it."""
