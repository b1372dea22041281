/// Eigen's decompositions and its kernel of matrix products: of a release those that the linker is
/// to keep; for what runs with Eigen's assertions (the everyday build, core's tests) compiled once
/// instead of in every source that uses them.
///
/// Part of the precompiled headers there (CMakeLists.txt). A source that is compiled without them
/// makes its own instances, which are the same.
#pragma once

#include <Eigen/Dense>

/// @param key  `extern`: they are elsewhere; nothing: they are here.
#define RECALD_EIGEN_INSTANCES(key)                                                               \
  namespace Eigen {                                                                               \
  key template class LLT<MatrixXd>;                                                               \
  key template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);                 \
  key template class LDLT<MatrixXd>;                                                              \
  key template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);               \
  key template class SelfAdjointEigenSolver<MatrixXd>;                                            \
  key template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(       \
      const EigenBase<MatrixXd>&, int);                                                           \
  }                                                                                               \
  namespace Eigen::internal {                                                                     \
  key template struct gebp_kernel<double, double, Index,                                          \
                                  blas_data_mapper<double, Index, ColMajor>, KernelSizes::mr,     \
                                  KernelSizes::nr, false, false>;                                 \
  key template struct gemm_pack_lhs<                                                              \
      double, Index, const_blas_data_mapper<double, Index, ColMajor>, KernelSizes::mr,            \
      KernelSizes::LhsProgress, KernelSizes::LhsPacket4Packing, ColMajor>;                        \
  key template struct gemm_pack_lhs<                                                              \
      double, Index, const_blas_data_mapper<double, Index, RowMajor>, KernelSizes::mr,            \
      KernelSizes::LhsProgress, KernelSizes::LhsPacket4Packing, RowMajor>;                        \
  key template struct gemm_pack_rhs<                                                              \
      double, Index, const_blas_data_mapper<double, Index, ColMajor>, KernelSizes::nr, ColMajor>; \
  key template struct gemm_pack_rhs<                                                              \
      double, Index, const_blas_data_mapper<double, Index, RowMajor>, KernelSizes::nr, RowMajor>; \
  }

namespace Eigen::internal {
using KernelSizes = gebp_traits<double, double>;
}

RECALD_EIGEN_INSTANCES(extern)
