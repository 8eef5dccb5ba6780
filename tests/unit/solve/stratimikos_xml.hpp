#pragma once

namespace lockstep::test {

inline constexpr const char* minres_with_teko = R"(
<ParameterList name="Coupled Solver">
  <Parameter name="Linear Solver Type" type="string" value="Belos"/>
  <Parameter name="Preconditioner Type" type="string" value="Teko"/>
  <ParameterList name="Linear Solver Types">
    <ParameterList name="Belos">
      <Parameter name="Solver Type" type="string" value="MINRES"/>
      <ParameterList name="Solver Types">
        <ParameterList name="MINRES">
          <Parameter name="Convergence Tolerance" type="double" value="1e-10"/>
          <Parameter name="Maximum Iterations" type="int" value="300"/>
        </ParameterList>
      </ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Preconditioner Types">
    <ParameterList name="Teko">
      <Parameter name="Inverse Type" type="string" value="Coupled"/>
      <ParameterList name="Inverse Factory Library">
        <ParameterList name="Coupled">
          <Parameter name="Type" type="string" value="SPD Block Diagonal"/>
          <Parameter name="Fluid Inverse Type" type="string" value="Fluid"/>
          <Parameter name="Solid Inverse Type" type="string" value="Solid"/>
        </ParameterList>
        <ParameterList name="Fluid">
          <Parameter name="Type" type="string" value="MueLu"/>
          <Parameter name="verbosity" type="string" value="none"/>
          <Parameter name="smoother: type" type="string" value="CHEBYSHEV"/>
          <Parameter name="coarse: max size" type="int" value="100"/>
          <Parameter name="coarse: type" type="string" value="RELAXATION"/>
          <ParameterList name="coarse: params">
            <Parameter name="relaxation: type" type="string" value="Symmetric Gauss-Seidel"/>
            <Parameter name="relaxation: sweeps" type="int" value="8"/>
          </ParameterList>
        </ParameterList>
        <ParameterList name="Solid">
          <Parameter name="Type" type="string" value="Ifpack2"/>
          <Parameter name="Prec Type" type="string" value="RILUK"/>
          <Parameter name="Overlap" type="int" value="0"/>
          <ParameterList name="Ifpack2 Settings">
            <Parameter name="fact: iluk level-of-fill" type="int" value="0"/>
          </ParameterList>
        </ParameterList>
      </ParameterList>
    </ParameterList>
  </ParameterList>
</ParameterList>)";

}  // namespace lockstep::test
