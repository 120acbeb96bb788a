"""What a run gives: the solution, its tables, its ledger, and its states between saved times."""
