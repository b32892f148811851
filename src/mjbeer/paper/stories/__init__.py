"""The paper's scenarios as plots and films: one file a chapter, named like the chapter's equations."""
