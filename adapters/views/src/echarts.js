// The parts of Apache ECharts that the reports' figures use.
import { use } from "echarts/core";
import { BarChart, BoxplotChart, CustomChart, LineChart, ScatterChart } from "echarts/charts";
import {
  AriaComponent,
  GraphicComponent,
  GridComponent,
  TooltipComponent,
} from "echarts/components";
import { SVGRenderer } from "echarts/renderers";

export { mount } from "./mount.js";

use([
  AriaComponent,
  BarChart,
  BoxplotChart,
  CustomChart,
  GraphicComponent,
  GridComponent,
  LineChart,
  ScatterChart,
  SVGRenderer,
  TooltipComponent,
]);
