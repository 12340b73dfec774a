"""Everything a plugin author or a script imports; names are imported when first used.

`__init__.pyi` says where each name is from.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
