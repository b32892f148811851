"""The paper's scenarios as plots and films, a file a chapter; they import the audit and the equations."""
