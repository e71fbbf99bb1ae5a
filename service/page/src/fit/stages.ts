// The stages and terms of a fit as a person reads them.
import { plainName, wordFor } from "../messages/words";
import { messages } from "../messages";

/** In the order they run. */
export const STAGES = [
  "observation",
  "initial_pose",
  "segmentation",
  "silhouette_and_edges",
  "shading",
  "measurement",
  "export",
] as const;

export function termLabel(name: string): string {
  return wordFor(messages.fit.terms, name) ?? plainName(name);
}

export function stageLabel(name: string): string {
  const stage = STAGES.find((each) => each === name);
  return stage ? messages.fit.stages[stage].label : plainName(name);
}
