"""The command line; it imports everything else, and nothing imports it."""
