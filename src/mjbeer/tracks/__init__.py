"""Tracks of filmed cans, and what they tell of the can.

- `track`: a track, and the tables in which people have it.
- `fit`: what was in the can. It takes its steps from the chapters below, in this order:
- `unknowns`: what is sought, and how the solver sees it.
- `track_model`: the track that a scene would give.
- `first_guess`: where the search begins.
- `least_squares`: the search, and the errors of what it finds.
- `doubts`: what speaks against it.
"""
