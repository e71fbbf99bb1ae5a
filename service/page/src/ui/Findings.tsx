// What is wrong with a picture, in words: why, and what to do.
import type { Finding } from "../api/types";
import { messages } from "../messages";
import { answered } from "../ui/answered";

export function Findings({ findings }: { findings: readonly Finding[] }) {
  const { findings: words } = messages.measure;
  if (findings.length === 0) return null;
  return (
    <ul class="findings">
      {findings.map(({ code, severity, reason, remedy }) => (
        <li key={code} class={`note ${severity === "blocks" ? "is-problem" : ""}`} data-code={code}>
          <strong>{words[severity]}</strong>
          <p>{answered("findings", code) ?? `${reason} ${remedy}`}</p>
        </li>
      ))}
    </ul>
  );
}
