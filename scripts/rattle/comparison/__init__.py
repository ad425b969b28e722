"""Variants side by side: what differs in their inputs, and what differs in the answer."""
