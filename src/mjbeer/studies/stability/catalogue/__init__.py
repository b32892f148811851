"""A catalogue of stiff and extreme scenes, and of those in which the random search found errors."""
