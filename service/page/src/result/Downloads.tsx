// The files of a result.
import { useSignal } from "@preact/signals";
import { getFile } from "../api/calls";
import { problemFrom } from "../api/client";
import type { FitResult, Job, Problem } from "../api/types";
import { Icon } from "../ui/Icon";
import { ProblemNote } from "../ui/ProblemNote";
import { saveFile } from "../ui/save";

const LABELS: Readonly<Record<string, string>> = {
  "body_posed.glb": "Posed body with camera, light and skin",
  "body_canonical.glb": "Upright body",
  "body_posed_se.glb": "Posed body before shading refined it",
  "body_canonical_se.glb": "Upright body before shading refined it",
  "tapes.json": "Where each measurement is taken",
  "result.json": "Everything found, as numbers",
  "overlay.png": "Outline over the picture",
  "views.png": "The body from other sides",
  "segmentation.png": "What was taken for the person",
  "trimap.png": "What that began with",
  "albedo.png": "Albedo",
  "shading.png": "Shading by Eq. 1",
  "shading_lambertian.png": "Its diffuse part",
};

export function Downloads({ job, result }: { job: Job; result: FitResult }) {
  const problem = useSignal<Problem | null>(null);
  const sizes = new Map((result.artifacts ?? []).map((artifact) => [artifact.name, artifact.size]));
  const links = Object.entries(job.links.artifacts ?? {});
  const rank = (name: string) => Object.keys(LABELS).indexOf(name) + (name in LABELS ? 0 : 100);
  return (
    <details class="section fold-section">
      <summary>
        <h2>Files</h2>
      </summary>
      {problem.value && <ProblemNote problem={problem.value} />}
      <ul class="downloads">
        {links
          .sort(([a], [b]) => rank(a) - rank(b))
          .map(([name, path]) => (
            <li key={name}>
              <button
                type="button"
                onClick={async () => {
                  try {
                    saveFile(name, await getFile(path));
                    problem.value = null;
                  } catch (error) {
                    problem.value = problemFrom(error);
                  }
                }}
              >
                <Icon name="download" />
                <span>
                  {name}
                  <small>{LABELS[name]}</small>
                </span>
                <small>{sizeText(sizes.get(name))}</small>
              </button>
            </li>
          ))}
      </ul>
    </details>
  );
}

function sizeText(bytes: number | undefined): string {
  if (bytes === undefined) return "";
  return bytes < 1e6 ? `${Math.max(1, Math.round(bytes / 1e3))} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}
