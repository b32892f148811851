"""Tracks of filmed cans: `track` reads the tables that people have, `fit` tells from one what was in the can."""
