"""What is drawn over pictures and around them to explain them. It imports the drawn world, nothing else of drawing."""
