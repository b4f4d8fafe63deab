"""The panel chips: one module a chip family, each a record of facts."""
