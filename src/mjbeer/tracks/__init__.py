"""Tracks of filmed cans, and what they tell of the can.

- `track`: a track, and the tables in which people have it.
- `unknowns`: what a fit looks for, and how the solver sees it.
- `track_model`: the track that a scene would give.
- `first_guess`: where the search begins.
- `least_squares`: the search, and the errors of what it finds.
- `doubts`: what speaks against it.
- `result`: what is told of it, in words and pictures.
- `fit`: all of this in one call.
"""
