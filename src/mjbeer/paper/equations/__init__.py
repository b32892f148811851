"""The paper's equations, as printed and as they are right, a file a chapter; they import `theory`, and no simulator."""
