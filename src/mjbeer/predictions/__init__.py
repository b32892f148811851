"""What theory says of numerical errors in advance; it imports `theory`, and no simulator."""
