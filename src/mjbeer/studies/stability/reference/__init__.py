"""A second exact motion, integrated from the Lagrangian by Taylor series; it shares no code with `mjbeer.theory`."""
