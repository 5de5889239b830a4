"""Many runs of a case: designs, parallel execution, tables, probability maps and sensitivity."""
