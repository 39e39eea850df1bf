"""Blind predictions of published experiments: one module per experiment, each with rows() -> [Row]."""
