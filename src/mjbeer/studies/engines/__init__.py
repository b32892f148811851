"""How well physics engines roll a can: their motions, which `make engines` makes, are judged."""
