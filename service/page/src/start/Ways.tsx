// The two ways in: one picture, or front and side.
import { messages } from "../messages";
import { openFile } from "../panel/open";
import { MEASURE_ADDRESS } from "../route";
import { Icon } from "../ui/Icon";
import { isTouched } from "../ui/touch";

export function Ways() {
  const { ways, choose, take } = messages.start;
  return (
    <ul class="start-ways">
      <li>
        <h2>{ways.one.title}</h2>
        <p>{ways.one.text}</p>
        <label class="button is-primary">
          <Icon name="picture" />
          {isTouched ? take : choose}
          <input
            class="unseen"
            type="file"
            accept="image/*"
            onChange={(event) => {
              const file = event.currentTarget.files?.[0];
              event.currentTarget.value = "";
              if (file) void openFile(file);
            }}
          />
        </label>
      </li>
      <li>
        <h2>{ways.two.title}</h2>
        <p>{ways.two.text}</p>
        <a class="button is-primary" href={MEASURE_ADDRESS}>
          <Icon name="body" />
          {ways.two.go}
        </a>
      </li>
    </ul>
  );
}
