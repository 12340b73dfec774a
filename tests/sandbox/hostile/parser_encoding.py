# Declares an encoding that turns harmless text into code.
# -*- coding: rot13 -*-
# expect: SketchRuntimeError line 5: NameError: name 'cevag' is not defined
# answer: plan
cevag("uryyb")
