// Whose fits the list shows, and the way to all of that person.
import { useEffect } from "preact/hooks";
import { messages } from "../messages/language";
import { knownLabels, lookForPeople } from "../people/known";
import { personAddress } from "../route";

interface Props {
  /** Those of the list itself. */
  readonly labels: readonly string[];
  readonly chosen: string | null;
  readonly onChoose: (label: string | null) => void;
  readonly onLeave: () => void;
}

export function PersonFilter({ labels, chosen, onChoose, onLeave }: Props) {
  const { people: words } = messages.value;
  useEffect(() => void lookForPeople(), []);
  const all = [...new Set([...labels, ...knownLabels.value])].sort((one, other) => one.localeCompare(other));
  if (all.length === 0) return null;
  return (
    <div class="person-filter">
      <div class="field">
        <label for="history-person">{words.whose}</label>
        <select id="history-person" value={chosen ?? ""} onChange={({ currentTarget: { value } }) => onChoose(value === "" ? null : value)}>
          <option value="">{words.everybody}</option>
          {all.map((label) => (
            <option key={label} value={label}>
              {label}
            </option>
          ))}
        </select>
      </div>
      {chosen !== null && (
        <a class="button is-small" href={personAddress(chosen)} onClick={onLeave}>
          {words.all}
        </a>
      )}
    </div>
  );
}
