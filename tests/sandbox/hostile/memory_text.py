# Fills the memory with text, while loading.
# expect: SketchMemoryError line 4: MemoryError
# answer: plan
gen_plan = "x" * 10**12
