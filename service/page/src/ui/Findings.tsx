// What is wrong with a picture, in words: why, and what to do.
import type { Remark } from "../api/types";
import { messages } from "../messages";
import { remarked } from "../ui/answered";

export function Findings({ findings }: { findings: readonly Remark[] }) {
  const { findings: words } = messages.measure;
  if (findings.length === 0) return null;
  return (
    <ul class="findings">
      {findings.map((remark) => (
        <li key={remark.code} class={`note ${remark.severity === "blocks" ? "is-problem" : ""}`} data-code={remark.code}>
          <strong>{remark.severity === "blocks" ? words.blocks : words.harms}</strong>
          <p>{remarked(remark)}</p>
        </li>
      ))}
    </ul>
  );
}
