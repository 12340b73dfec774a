"""What a run folder has to say, for people: `explain` in words.

`story` reads the log into rounds and programs, whatever of them is there; `changes` compares a program with
the one before it; `pointers` picks the places that a person would look at; `explanation` puts all this into
words, which stand in templates (`explain.j2`, `look.j2`) and may be replaced like any other template.
"""
