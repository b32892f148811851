"""McDonald's paper; it imports all but `studies`, `report` and `cli`."""
