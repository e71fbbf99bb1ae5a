// The report.
import { person } from "../../draft/draft";
import { messages } from "../../messages";
import type { Kind, OptionProps } from "./kind";

interface ReportWishes {
  /** Whose body it is, as the heading is to say; empty for nobody's. */
  readonly name: string;
}

const LONGEST_NAME = 80;

export const FIRST_REPORT: ReportWishes = { name: "" };

export const report: Kind<ReportWishes> = {
  request: ({ name }) => ({
    kind: "report",
    units: person.value.units,
    date: today(),
    ...(name.trim() ? { name: name.trim() } : {}),
  }),
  Options: Heading,
  pictures: [],
};

function Heading({ wishes: { name }, onWish }: OptionProps<ReportWishes>) {
  const { report: words } = messages.derived;
  return (
    <div class="field">
      <label for="report-name">{words.name}</label>
      <input
        id="report-name"
        type="text"
        autocomplete="off"
        maxLength={LONGEST_NAME}
        value={name}
        onInput={(event) => onWish({ name: event.currentTarget.value })}
      />
    </div>
  );
}

/** Of this place's calendar, which may be ahead of the service's. */
function today(): string {
  const now = new Date();
  const two = (value: number) => String(value).padStart(2, "0");
  return `${now.getFullYear()}-${two(now.getMonth() + 1)}-${two(now.getDate())}`;
}
