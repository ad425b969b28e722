"""Publication figures of motions; one module draws one kind of figure."""
