"""K. T. McDonald's paper on a can of beer: its equations, an audit of them, and its scenarios as plots and films."""
