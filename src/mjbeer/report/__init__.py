"""`mjbeer report`: the checks, the films, the paper's stories, and one page that shows it all. Only `cli` uses it."""
