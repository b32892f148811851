"""Files, folders, jobs, tables, plots and the terminal: nothing that depends on the physics."""
