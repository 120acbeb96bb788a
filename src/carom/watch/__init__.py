"""Events and switches: conditions, and a run that is watched for them."""
