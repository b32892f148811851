"""A search, with seeded random numbers, for runs that are trusted although they are wrong."""
