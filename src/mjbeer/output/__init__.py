"""Files, tables, plots and the terminal. Nothing here depends on the physics, and no other folder is imported."""
