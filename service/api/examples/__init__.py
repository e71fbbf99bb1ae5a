"""Values for the examples of the OpenAPI document; long lists are cut short."""
