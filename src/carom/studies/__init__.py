"""Many runs of one scene: ensembles, sensitivities, identification."""
