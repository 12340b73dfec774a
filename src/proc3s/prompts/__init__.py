"""From templates to messages, and from an answer to a program."""
