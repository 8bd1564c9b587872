#include "integrator/bdpt.h"

#include "integrator/bidirectional_worker.h"

namespace turbid {
std::unique_ptr<SplattingIntegrator::Worker> BidirectionalPathTracer::make_worker(const Scene& scene, uint64_t seed,
                                                                                  SampleCounters& counters) const {
  using Tracer = BidirectionalWorker<SensorSubpath>;
  return std::make_unique<Tracer>(
      Tracer::Shared{scene, *sources_, settings_, weights_, own_.connections, scattering_.get()}, seed, counters);
}

Parameter heuristic_parameter(const std::string& value) {
  return {"heuristic", ParameterType::kString, value, "how the ways to make a path share it: power or balance"};
}

Parameter connections_parameter() {
  return {"connections",
          ParameterType::kFloat,
          "8",
          "about how many of the joining lines are tried for paths of one length",
          {.min = 1}};
}

StrategyWeights::Heuristic heuristic_of(const Properties& properties) {
  const std::string heuristic = properties.string("heuristic");
  if (heuristic != "power" && heuristic != "balance")
    properties.refuse("heuristic", "must be 'power' or 'balance', found '" + heuristic + "'");
  return heuristic == "power" ? StrategyWeights::Heuristic::kPower : StrategyWeights::Heuristic::kBalance;
}

IntegratorPlugin bdpt_row() {
  return {"bdpt",
          {},
          "bidirectional path tracing: paths from lights and from the sensor, joined in all ways and weighed against "
          "each other",
          with_common_parameters(
              {heuristic_parameter("power"),
               connections_parameter(),
               {"visualize_strategies", ParameterType::kBoolean, "false",
                "writes what each way contributes as layers strategy.weighted.K.S and strategy.plain.K.S: K edges, S "
                "vertices from the light"},
               {"visualize_depth",
                ParameterType::kInteger,
                "6",
                "most edges of the paths in these layers",
                {.min = 1, .max = 16}},
               single_scattering_parameter()}),
          [](const Properties& properties) {
            BdptSettings own;
            own.heuristic = heuristic_of(properties);
            own.connections = properties.number("connections");
            own.refraction = refraction_settings(properties);
            if (properties.boolean("visualize_strategies"))
              own.shown_edges = static_cast<int>(properties.integer("visualize_depth"));
            return IntegratorSetup{std::make_shared<BidirectionalPathTracer>(path_settings(properties), own), false};
          }};
}

}  // namespace turbid
