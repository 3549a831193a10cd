#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

"""Asks an independent validator: validate_json.py SCHEMA FILE...

Prints "FILE: valid" or "FILE: PLACE: what is wrong" for each. Exits 1 where the schema itself is none.
"""
import json
import pathlib
import sys

import jsonschema

schema = json.loads(pathlib.Path(sys.argv[1]).read_text())
kind = jsonschema.validators.validator_for(schema)
try:
    kind.check_schema(schema)
except jsonschema.SchemaError as error:
    sys.exit(f"{sys.argv[1]} is no schema: {error.message}")
for file in sys.argv[2:]:
    errors = list(kind(schema).iter_errors(json.loads(pathlib.Path(file).read_text())))
    if not errors:
        print(f"{file}: valid")
    for error in errors:
        print(f"{file}: {'.'.join(map(str, error.absolute_path))}: {error.message.splitlines()[0][:200]}")
