"""What would stop the rattle of a gear pair: how far what a designer can change has to move."""
