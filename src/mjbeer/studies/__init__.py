"""What is measured about the models; all studies share the files here, and do not know each other."""
