// The files of a result.
import type { Fit, Result } from "../api/fits";
import { messages } from "../messages";
import { FileButton } from "./FileButton";
import { tableOf } from "./files";

export function Downloads({ fit, result }: { fit: Fit; result: Pick<Result, "artifacts" | "measurements"> }) {
  const sizes = new Map((result.artifacts ?? []).map((artifact) => [artifact.name, artifact.size]));
  const table = result.measurements.length > 0 ? [tableOf(fit)] : [];
  const links = [...Object.entries(fit.links.artifacts ?? {}), ...table];
  const order = Object.keys(messages.files.labels);
  const rank = (name: string) => (order.includes(name) ? order.indexOf(name) : order.length);
  return (
    <details class="section fold-section">
      <summary>
        <h2>{messages.files.title}</h2>
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
