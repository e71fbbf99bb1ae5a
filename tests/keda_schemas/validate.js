// Reads KEDA's resources from standard input, a JSON list, and writes what is wrong with each.
import { readFileSync } from "node:fs";
import * as keda from "@kubernetes-models/keda/keda.sh/v1alpha1";

function fault(resource) {
  const Kind = keda[resource.kind];
  if (Kind?.kind !== resource.kind || Kind.apiVersion !== resource.apiVersion) return "unknown kind";
  try {
    new Kind(resource).validate();
    return null;
  } catch (error) {
    return error.message;
  }
}

console.log(JSON.stringify(JSON.parse(readFileSync(0)).map(fault)));
