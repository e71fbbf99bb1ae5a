// Swagger UI, with what makes "Try it out" and "Execute" succeed at once: the sample picture and the newest fit.
const SOME_FIT = "b0d3cd76-33ef-4c01-b18c-190159d7df68"; // as in the examples: the answer says that it is not there
const SAMPLE = { gender: "male", height_m: 1.804 };
const ASKED = { submit_fit: SAMPLE, propose_points: { view: "front", height_m: SAMPLE.height_m } };

const [api, fits, picture] = await Promise.all([
  fetch("/openapi.json").then((answer) => answer.json()),
  fetch("/v1/fits?state=succeeded&limit=1").then((answer) => (answer.ok ? answer.json() : { fits: [] })),
  fetch("/page/sample.jpg").then((answer) => answer.blob()),
]);

// Errors are all alike: what they say is enough.
for (const answer of Object.values(api.components.responses)) delete answer.content;
for (const path of Object.values(api.paths)) for (const operation of Object.values(path)) prepare(operation);

SwaggerUIBundle({
  spec: api,
  dom_id: "#api",
  deepLinking: true,
  displayRequestDuration: true,
  persistAuthorization: false,
  validatorUrl: null,
});

function prepare({ operationId, parameters = [], requestBody }) {
  const { fit_id } = Object.fromEntries(parameters.map((each) => [each.name, each]));
  if (fit_id) fit_id.example = fits.fits[0]?.id ?? SOME_FIT;
  const parts = requestBody?.content["multipart/form-data"]?.schema.properties ?? {};
  if (ASKED[operationId]) parts.request.example = ASKED[operationId];
  delete parts.mask; // an empty one would be sent with every fit
}

// A picture is chosen already.
new MutationObserver(() => {
  for (const input of document.querySelectorAll('[data-property-name="image"] input[type="file"]:not([data-filled])')) {
    input.dataset.filled = "";
    const chosen = new DataTransfer();
    chosen.items.add(new File([picture], "sample.jpg", { type: picture.type }));
    input.files = chosen.files;
    input.dispatchEvent(new Event("change", { bubbles: true }));
  }
}).observe(document.getElementById("api"), { childList: true, subtree: true });
