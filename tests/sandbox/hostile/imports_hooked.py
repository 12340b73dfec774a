# Brings a module of its own by way of the import system.
# expect: SketchRuntimeError line 8: FileNotFoundError
# friendly: SketchRuntimeError line 10: ImportError: 'evil' cannot be imported here
# answer: plan
sys = random._os.sys
class Finder:
    def find_spec(self, name, path=None, target=None):
        raise FileNotFoundError(name)
sys.meta_path.insert(0, Finder)
import evil
