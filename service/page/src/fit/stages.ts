// The stages of a fit as a person reads them.

export const STAGES = [
  { name: "observation", label: "Picture", help: "read, and its lens found" },
  { name: "initial_pose", label: "Pose", help: "from the clicks" },
  { name: "segmentation", label: "Person", help: "cut out of the background" },
  { name: "silhouette_and_edges", label: "Outline", help: "silhouette and edges matched" },
  { name: "shading", label: "Shading", help: "light and skin found, shape refined" },
  { name: "measurement", label: "Measures", help: "taken, with their uncertainty" },
  { name: "export", label: "Files", help: "written" },
] as const;

const TERMS: Readonly<Record<string, string>> = {
  silhouette: "Silhouette",
  edges: "Edges",
  penetration: "Penetration",
  clicks: "Clicks",
  shape_prior: "Unusual shape",
  pose_prior: "Unusual pose",
  stance: "Unusual stance",
  shading: "Shading",
  measurements: "Known measures",
};

export function termLabel(name: string): string {
  return TERMS[name] ?? name.replaceAll("_", " ");
}

export function stageLabel(name: string): string {
  return STAGES.find((stage) => stage.name === name)?.label ?? name.replaceAll("_", " ");
}
