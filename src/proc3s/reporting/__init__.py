"""What a run folder has to say, for people: `explain` in words, `report` as a page.

`history` reads the log into rounds and programs, as far as they are there; `changes` compares a program with
the one before it; `advice` picks the places that a person would look at; `explanation` and `page` put all
this into words and HTML, which stand in templates (`explain.j2`, `report.j2`) and may be replaced like any
other template.
"""
