"""Files, tables, plots and the terminal; it knows no physics and imports no other folder."""
