// Nothing of its own: it makes plumbline_test_headers a target that headers can be precompiled for.
