// The generator knows one content type for each operation, and prefers JSON: what is to be sent as
// a form has its JSON taken away.
const asForm = (operation) => {
  delete operation.requestBody.content['application/json'];
};

export default {
  input: process.env.OPENAPI,
  output: { path: 'client', module: { extension: '.js' } },
  plugins: ['@hey-api/client-fetch', '@hey-api/typescript', '@hey-api/sdk'],
  parser: {
    patch: {
      operations: {
        'POST /v1/fits': asForm,
        'POST /v1/fits/{fit_id}/derivations': asForm,
      },
    },
  },
};
