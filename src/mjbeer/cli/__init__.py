"""The command line `mjbeer`. It may import every other folder, and no other folder imports it."""
