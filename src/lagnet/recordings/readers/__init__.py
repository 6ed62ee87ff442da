"""One file format a module: each opens bytes as a `TableSource`, names first, then the columns asked for."""
