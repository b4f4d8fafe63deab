"""The examples, runnable by name: ``paneldraw demo clock``."""
