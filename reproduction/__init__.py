"""The paper's figures and sentences beside what the simulator gives: run all its cases, draw, compare, write a page."""
