// The files of a result.
import type { FitResult, Job, Scan } from "../api/types";
import { FILE_LABELS, FileButton } from "./FileButton";
import { tableOf } from "./files";

export function Downloads({ job, result }: { job: Job | Scan; result: Pick<FitResult, "artifacts" | "measurements"> }) {
  const sizes = new Map((result.artifacts ?? []).map((artifact) => [artifact.name, artifact.size]));
  const table = result.measurements.length > 0 ? [tableOf(job)] : [];
  const links = [...Object.entries(job.links.artifacts ?? {}), ...table];
  const rank = (name: string) => Object.keys(FILE_LABELS).indexOf(name) + (name in FILE_LABELS ? 0 : 100);
  return (
    <details class="section fold-section">
      <summary>
        <h2>Files</h2>
      </summary>
      <ul class="downloads">
        {links
          .sort(([a], [b]) => rank(a) - rank(b))
          .map(([name, path]) => (
            <li key={name}>
              <FileButton name={name} path={path} bytes={sizes.get(name)} />
            </li>
          ))}
      </ul>
    </details>
  );
}
